#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/depth_order.h"
#include "lines/directions.h"
#include "lines/ray_scene.h"
#include "parallux/error.h"
#include "parallux/lines.h"
#include "surfaces/curve.h"

namespace parallux {

LineSphere line_sphere(const Scene& scene, double wanted_radius) {
    Bounds bounds = scene_bounds(scene);
    LineSphere sphere;
    sphere.centre = 0.5 * (bounds.low + bounds.high);
    for (const Surface& surface : scene.surfaces)
        for (std::uint32_t corner : surface.corner)
            if (corner != none)
                sphere.radius =
                    std::max(sphere.radius, glm::distance(sphere.centre, scene.positions[corner]));
    // About a curve's own box, which is a little too large: so that no point is left out.
    for (const Surface& surface : scene.surfaces) {
        if (!surface.is_curved())
            continue;
        const Curve& curve = scene.curves[surface.curve];
        if (is_whole_sphere(curve)) {
            sphere.radius = std::max(
                sphere.radius, glm::distance(sphere.centre, sphere_centre(curve)) + curve.radius);
            continue;
        }
        const Bounds box = curve_bounds(curve, 0, 1, 0, 1, 64);
        const double bound = glm::distance(sphere.centre, 0.5 * (box.low + box.high)) +
                             0.5 * glm::length(box.high - box.low);
        double farthest = 0;
        for (int k = 0; k <= 64 * 65; ++k)
            farthest = std::max(
                farthest,
                glm::distance(sphere.centre, curve_at(curve, k % 65 / 64.0, k / 65 / 64.0).at));
        sphere.radius = std::max(sphere.radius, std::min(bound, 1.005 * farthest));
    }
    if (wanted_radius <= 0)
        wanted_radius = scene.line_sphere;
    if (wanted_radius > 0) {
        if (wanted_radius < sphere.radius)
            throw Error(Fault::usage, "a line sphere of radius " + std::to_string(wanted_radius) +
                                          " m does not hold the scene, whose radius is " +
                                          std::to_string(sphere.radius) + " m");
        sphere.radius = wanted_radius;
    }
    return sphere;
}

namespace {

// Surfaces that lie in one place (a solid on a floor) are met at depths that rounding decides: the
// one met from behind comes first, since the gap is between them.
void order_coincident(const Scene& scene, std::vector<SurfaceHit>& hits, float same) {
    for (std::size_t k = 1; k < hits.size(); ++k) {
        SurfaceHit &a = hits[k - 1], &b = hits[k];
        if (b.t - a.t <= same && b.back && !a.back && a.surface != b.surface &&
            !touch(scene.surfaces[a.surface], scene.surfaces[b.surface]))
            std::swap(a, b);
    }
}

}  // namespace

void trace_lines(const RayScene& rays, const Scene& scene, const Patches& patches,
                 const LineSphere& sphere, std::uint64_t seed, std::uint64_t first,
                 std::size_t count, IntersectionLists& lists, std::vector<glm::dvec3>* directions) {
    if (directions)
        directions->clear();
    lists.start.assign(1, 0);
    lists.hits.clear();
    std::vector<SurfaceHit> hits;
    DenormalsOff guard;
    for (std::size_t k = 0; k < count; ++k) {
        // A uniform direction, and a uniform point of the disk across it: every line through the
        // sphere is as likely as any other.
        Random random(seed, stream::lines + first + k);
        glm::dvec3 direction = uniform_direction(random), x, y;
        frame_across(direction, x, y);
        if (directions)
            directions->push_back(direction);
        double square = 0;
        glm::dvec2 place = sphere.radius * uniform_disk(random, square);
        glm::dvec3 across = place.x * x + place.y * y;
        double half = 1.001 * sphere.radius;
        rays.all(sphere.centre + across - half * direction, direction, 2 * half, hits);
        order_coincident(scene, hits, 1e-6f * static_cast<float>(sphere.radius));
        for (const SurfaceHit& crossing : hits) {
            const SurfaceGrid& grid = patches.grids[crossing.surface];
            Shape shape = scene.surfaces[crossing.surface].shape();
            std::uint32_t cell = cell_at(shape, grid.nu, grid.nv, crossing.u, crossing.v);
            std::uint32_t front = grid.front + cell;
            std::uint32_t back = grid.back == none ? none : grid.back + cell;
            // Met from behind: the traveller comes upon the back and leaves the front.
            lists.hits.push_back({crossing.t, crossing.surface, crossing.back ? back : front,
                                  crossing.back ? front : back});
        }
        lists.start.push_back(static_cast<std::uint32_t>(lists.hits.size()));
    }
}

}  // namespace parallux
