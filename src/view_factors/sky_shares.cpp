#include "view_factors/sky_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "factors/gauss_legendre.h"
#include "factors/open_sky.h"
#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "patches/patch_values.h"

namespace parallux {

namespace {

// One side of a cell of a surface's grid: a triangle or a parallelogram.
struct Side {
    glm::dvec3 origin, u, v, normal;
    Shape shape;
    std::uint32_t node;
    double area;
};

std::vector<Side> sides_of(const Scene& scene, const Patches& patches, const NodeMap& nodes) {
    std::vector<Side> sides;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const SurfaceGrid& grid = patches.grids[s];
        const double area = surface_area(scene, surface) / (double(grid.nu) * grid.nv);
        const glm::dvec3 normal = surface_normal(scene, surface);
        for (std::uint32_t first : {grid.front, grid.back}) {
            if (first == none)
                continue;
            for_each_cell(surface.shape(), grid, [&](const Cell& c) {
                const glm::dvec3 origin = surface_point(scene, surface, c.u0, c.v0);
                sides.push_back({origin, surface_point(scene, surface, c.u0 + c.du, c.v0) - origin,
                                 surface_point(scene, surface, c.u0, c.v0 + c.dv) - origin,
                                 first == grid.back ? -normal : normal, surface.shape(),
                                 nodes.of_patch[first + c.index], area});
            });
        }
    }
    return sides;
}

// By n × n points of the product rule, on triangles drawn together into the origin (A. Stroud,
// Approximate Calculation of Multiple Integrals, 1971).
double mean_sky(const Side& side, std::size_t n, SkyBlockers::View& view) {
    const bool triangle = side.shape == Shape::triangle;
    const GaussRule rule(n);
    double sum = 0;
    for (const GaussNode& a : rule)
        for (const GaussNode& b : rule) {
            const double s = (1 + a.place) / 2, t = (1 + b.place) / 2;
            const glm::dvec3 place =
                triangle ? s * ((1 - t) * side.u + t * side.v) : s * side.u + t * side.v;
            sum += a.weight * b.weight / 4 * (triangle ? 2 * s : 1) * view.sky(side.origin + place);
        }
    return sum;
}

struct Mean {
    double value, change;
};

Mean refined_sky(const Side& side, double tolerance, SkyBlockers::View& view) {
    const std::array<glm::dvec3, 4> corners{side.origin, side.origin + side.u, side.origin + side.v,
                                            side.origin + side.u + side.v};
    view.turn({corners.data(), side.shape == Shape::triangle ? 3u : 4u}, side.normal);
    Mean mean{mean_sky(side, 2, view), 1};
    for (std::size_t n : {3u, 5u, 8u}) {
        const double finer = mean_sky(side, n, view);
        mean = {finer, std::fabs(finer - mean.value)};
        if (mean.change < tolerance)
            break;
    }
    // What rounding may have left.
    return {std::clamp(mean.value, 0.0, 1.0), mean.change + 1e-8};
}

}  // namespace

bool sky_from_points(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                     double line_spacing) {
    const bool can =
        !is_periodic(scene) && !has_curves(scene) && settings.sky_parts == SkyParts::whole;
    if (settings.sky_from == SkyFrom::lines)
        return false;
    if (settings.sky_from == SkyFrom::points && !can)
        throw Error(Fault::usage,
                    "sky factors from points are of scenes that do not repeat, of planar surfaces, "
                    "and of the whole sky");
    if (settings.sky_from == SkyFrom::points || !can)
        return can;
    // As measured: a cell takes some 0.9 µs for each face, a line 20 ns.
    constexpr std::size_t most_faces = 4096;
    const double radius = line_sphere(scene).radius / line_spacing;
    const double lines = static_cast<double>(settings.bundles) * pi * radius * radius;
    double cells = 0;
    for (const SurfaceGrid& grid : patches.grids)
        cells += double(grid.nu) * grid.nv * ((grid.front != none) + (grid.back != none));
    return scene.surfaces.size() <= most_faces &&
           21 * cells * static_cast<double>(scene.surfaces.size()) <= lines;
}

SkyShares sky_shares(const Scene& scene, const Patches& patches, const NodeMap& nodes,
                     double tolerance, unsigned threads) {
    const SkyBlockers blockers(scene);
    const std::vector<Side> sides = sides_of(scene, patches, nodes);
    std::vector<Mean> means(sides.size());
    std::vector<SkyBlockers::View> views(threads, SkyBlockers::View(blockers));
    parallel_for(threads, sides.size(), 4,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     for (std::size_t k = begin; k < end; ++k)
                         means[k] = refined_sky(sides[k], tolerance, views[worker]);
                 });
    SkyShares shares{std::vector<double>(nodes.nodes.size(), 0), {}};
    shares.error = shares.sky;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const double weight = sides[k].area / nodes.nodes[sides[k].node].area;
        shares.sky[sides[k].node] += weight * means[k].value;
        shares.error[sides[k].node] += weight * means[k].change;
    }
    return shares;
}

}  // namespace parallux
