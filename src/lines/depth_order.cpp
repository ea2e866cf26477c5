#include "lines/depth_order.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "lines/edge_walk.h"

namespace parallux {

namespace {

struct Lattice {
    std::int64_t x, y;  // fixed point
};

std::int64_t cross(Lattice a, Lattice b, Lattice c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The depth of a surface at a line, interpolated between its snapped corners: exact in the place,
// double in the depth. A parallelogram is taken as two triangles, since its snapped corners need
// not be quite in one plane.
double exact_depth(const Projection& projection, const Scene& scene, const glm::dvec3& centre,
                   double radius, const Surface& surface, Lattice line) {
    auto at = [&](unsigned k) {
        const Projection::Corner& corner = projection.corners[surface.corner[k]];
        return Lattice{corner.x, corner.y};
    };
    auto depth = [&](unsigned k) {
        return glm::dot(scene.positions[surface.corner[k]] - centre, projection.bundle.direction) /
               radius;
    };
    unsigned b = 1, c = 2;
    if (surface.shape() == Shape::parallelogram) {
        std::int64_t side = cross(at(0), at(2), line), turn = cross(at(0), at(2), at(3));
        if ((side > 0) == (turn > 0)) {
            b = 2;
            c = 3;
        }
    }
    double total = static_cast<double>(cross(at(0), at(b), at(c)));
    if (total == 0)
        return depth(0);
    double of_b = static_cast<double>(cross(at(0), line, at(c))) / total;
    double of_c = static_cast<double>(cross(at(0), at(b), line)) / total;
    return depth(0) + of_b * (depth(b) - depth(0)) + of_c * (depth(c) - depth(0));
}

bool touch(const Surface& a, const Surface& b) {
    for (std::uint32_t k : a.corner)
        for (std::uint32_t l : b.corner)
            if (k == l && k != none)
                return true;
    return false;
}

}  // namespace

void order_near_ties(const Projection& projection, const Scene& scene, const Patches& patches,
                     const glm::dvec3& centre, double radius, std::int32_t column, std::int32_t row,
                     Hit* begin, Hit* end) {
    float tie = near_tie(projection.bundle.spacing, radius);
    Lattice line{column * fixed_one, row * fixed_one};
    auto from_behind = [&](const Hit& hit) {
        const SurfaceGrid& grid = patches.grids[hit.surface];
        return hit.away != none && hit.away - grid.front < grid.nu * grid.nv;
    };
    auto before = [&](const Hit& a, const Hit& b) {
        const Surface& surface_a = scene.surfaces[a.surface];
        const Surface& surface_b = scene.surfaces[b.surface];
        bool touching = touch(surface_a, surface_b);
        double difference = exact_depth(projection, scene, centre, radius, surface_a, line) -
                            exact_depth(projection, scene, centre, radius, surface_b, line);
        // Surfaces in one place differ by no more than their corners' snapping, at slopes to 16.
        double same = touching ? 0 : 16 * projection.bundle.spacing / radius / fixed_one;
        if (std::fabs(difference) > same)
            return difference < 0;
        if (from_behind(a) != from_behind(b))
            return from_behind(a);
        return a.surface < b.surface;
    };
    for (Hit* k = begin + 1; k < end; ++k) {
        Hit hit = *k;
        Hit* place = k;
        for (; place > begin && hit.depth - place[-1].depth < tie && before(hit, place[-1]);
             --place)
            *place = place[-1];
        *place = hit;
    }
}

}  // namespace parallux
