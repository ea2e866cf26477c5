#include "lines/depth_order.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/ball.h"
#include "lines/edge_walk.h"
#include "lines/facets.h"
#include "lines/sheets.h"

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
                   std::uint32_t s, std::int32_t column, std::int32_t row) {
    const Surface& surface = scene.surfaces[s];
    const Lattice line{column * fixed_one, row * fixed_one};
    auto at = [&](unsigned k) {
        const Projection::Corner& corner = projection.corners[surface.corner[k]];
        return Lattice{corner.x, corner.y};
    };
    auto depth = [&](unsigned k) {
        return glm::dot(scene.positions[surface.corner[k]] - centre, projection.bundle.direction) /
               projection.radius;
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

// The depth of a surface's own plane at a line, unsnapped, in radii.
double plane_depth(const Projection& projection, const Scene& scene, const glm::dvec3& centre,
                   std::uint32_t s, std::int32_t column, std::int32_t row) {
    const Bundle& bundle = projection.bundle;
    const glm::dvec3 normal = surface_normal(scene, scene.surfaces[s]);
    const glm::dvec3 line = bundle.spacing * ((column - bundle.offset_x) * bundle.x +
                                              (row - bundle.offset_y) * bundle.y);
    const glm::dvec3 from_line = scene.positions[scene.surfaces[s].corner[0]] - centre - line;
    return glm::dot(from_line, normal) / glm::dot(bundle.direction, normal) / projection.radius;
}

// Whether two faces with a common corner meet like those of a solid: each lies behind the other.
bool convex(const Scene& scene, const Surface& a, const Surface& b) {
    glm::dvec3 normal = surface_normal(scene, a), origin = scene.positions[a.corner[0]];
    double height = 0;
    for (std::uint32_t corner : b.corner)
        if (corner != none)
            height += glm::dot(normal, scene.positions[corner] - origin);
    return height < 0;
}

}  // namespace

SurfaceRelations::Relation SurfaceRelations::find(const Surface& a, const Surface& b) const {
    if (a.is_curved() || b.is_curved())
        return apart;  // nothing asks: TieOrder has its own way
    const glm::dvec3 normal = surface_normal(scene_, a);
    const bool along = std::fabs(glm::dot(normal, surface_normal(scene_, b))) > 0.9999;
    if (!touch(a, b))
        return along ? parallel : apart;
    // Along each other from a common corner on: in one plane, if no corner leaves it.
    const glm::dvec3 origin = scene_.positions[a.corner[0]];
    for (std::uint32_t corner : b.corner)
        if (corner != none && std::fabs(glm::dot(normal, scene_.positions[corner] - origin)) >
                                  coordinate_rounding * radius_)
            return touching;
    return along ? parallel : touching;
}

SurfaceRelations::Relation SurfaceRelations::of(std::uint32_t a, std::uint32_t b) {
    if (a > b)
        std::swap(a, b);
    Known& known = known_[(a * 0x9e3779b1u ^ b * 0x85ebca77u) >> 20];
    if (known.a != a || known.b != b) {
        known = {a, b, find(scene_.surfaces[a], scene_.surfaces[b])};
    }
    return known.relation;
}

// Halves of spheres among themselves and with planes: by doubles, unsnapped. What touches is in one
// place only there; two identical spheres are by the scene's order.
bool TieOrder::before_curved(const Hit& a, const Hit& b) const {
    auto depth = [&](const Hit& hit) {
        const Surface& surface = scene_.surfaces[hit.surface];
        if (surface.is_curved())
            return ball_depth(projection_.balls[surface.curve], is_far_half(surface), column_,
                              row_);
        const double facing =
            glm::dot(surface_normal(scene_, surface), projection_.bundle.direction);
        return std::fabs(facing) > 1e-3
                   ? plane_depth(projection_, scene_, centre_, hit.surface, column_, row_)
                   : exact_depth(projection_, scene_, centre_, hit.surface, column_, row_);
    };
    const Surface &s = scene_.surfaces[a.surface], &t = scene_.surfaces[b.surface];
    if (s.curve == t.curve)
        return a.surface < b.surface;
    const double difference = depth(a) - depth(b);
    if (std::fabs(difference) > 1e-12)
        return difference < 0;
    const int a_rank = place_rank(from_behind(a), relations_.is_sheet(a.surface));
    const int b_rank = place_rank(from_behind(b), relations_.is_sheet(b.surface));
    return a_rank != b_rank ? a_rank < b_rank : (a.surface < b.surface) != from_behind(a);
}

bool TieOrder::before(const Hit& a, const Hit& b) const {
    if (scene_.surfaces[a.surface].is_curved() || scene_.surfaces[b.surface].is_curved())
        return before_curved(a, b);
    SurfaceRelations::Relation relation = relations_.of(a.surface, b.surface);
    // Surfaces of one plane differ by no more than their corners' snapping: at slopes to 16, or
    // what their own slopes make of it where the direction grazes them. Planes that cross are in
    // one place only on a line.
    const double moved = slack_[a.surface] + slack_[b.surface];
    const double same = relation == SurfaceRelations::parallel
                            ? std::max<double>(same_place(projection_), moved)
                            : 1e-14;
    // Depths as floats decide where neither their rounding nor the fold of a snapped parallelogram
    // can.
    double difference = static_cast<double>(a.depth) - static_cast<double>(b.depth);
    if (std::fabs(std::fabs(difference) - same) <= 2e-6 + moved)
        difference = exact_depth(projection_, scene_, centre_, a.surface, column_, row_) -
                     exact_depth(projection_, scene_, centre_, b.surface, column_, row_);
    if (std::fabs(difference) > same)
        return difference < 0;
    // Where snapping cannot tell, their own planes can: a lamp close below a ceiling, panels that
    // lean on each other.
    double gap = 0, across = 0;
    if (relation == SurfaceRelations::parallel) {
        gap = plane_depth(projection_, scene_, centre_, a.surface, column_, row_) -
              plane_depth(projection_, scene_, centre_, b.surface, column_, row_);
        across = gap * glm::dot(projection_.bundle.direction,
                                surface_normal(scene_, scene_.surfaces[a.surface]));
    }
    if (std::fabs(across) > coordinate_rounding)
        return gap < 0;
    const bool a_behind = from_behind(a), b_behind = from_behind(b);
    if (relation == SurfaceRelations::touching) {
        // A line along the edge of a solid enters it before it leaves.
        if (a_behind != b_behind)
            return a_behind !=
                   convex(scene_, scene_.surfaces[a.surface], scene_.surfaces[b.surface]);
    } else {
        const int a_rank = place_rank(a_behind, relations_.is_sheet(a.surface));
        const int b_rank = place_rank(b_behind, relations_.is_sheet(b.surface));
        if (a_rank != b_rank)
            return a_rank < b_rank;
    }
    if (std::fabs(gap) > 1e-9)
        return gap < 0;
    // Both look the same way; the first of the scene lies in front, from wherever it is met.
    return (a.surface < b.surface) != a_behind;
}

bool TieOrder::from_behind(const Hit& hit) const {
    const SurfaceGrid& grid = patches_.grids[hit.surface];
    return hit.away != none && hit.away - grid.front < grid.nu * grid.nv;
}

void order_near_ties(const Projection& projection, const Scene& scene, const Patches& patches,
                     const glm::dvec3& centre, std::int32_t column, std::int32_t row,
                     const std::vector<float>& slack, SurfaceRelations& relations, Hit* begin,
                     Hit* end) {
    const float tie = near_tie(projection.bundle.spacing, projection.radius);
    const TieOrder order(projection, scene, patches, centre, column, row, slack, relations);
    for (Hit* k = begin + 1; k < end; ++k) {
        Hit hit = *k;
        Hit* place = k;
        auto near = [&](const Hit& other) {
            return hit.depth - other.depth <
                   std::max(tie, slack[hit.surface] + slack[other.surface]);
        };
        for (; place > begin && near(place[-1]) && order.before(hit, place[-1]); --place)
            *place = place[-1];
        *place = hit;
    }
}

}  // namespace parallux
