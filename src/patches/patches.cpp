#include "parallux/patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "parallux/error.h"
#include "patches/clusters.h"
#include "patches/patch_values.h"
#include "surfaces/curve.h"

namespace parallux {

namespace {

// Sides of a surface that carry patches.
int sides(const Scene& scene, const Surface& surface) {
    return scene.materials[surface.material].two_sided ? 2 : 1;
}

double wanted_size(const Scene& scene, const PatchSettings& settings,
                   const std::vector<double>& areas) {
    if (settings.size > 0)
        return settings.size;
    bool all_given = std::all_of(scene.surfaces.begin(), scene.surfaces.end(),
                                 [](const Surface& s) { return s.grid_u && s.grid_v; });
    if (settings.count == 0 && all_given)
        return 0;
    double total = 0;
    for (std::size_t s = 0; s < areas.size(); ++s)
        total += areas[s] * sides(scene, scene.surfaces[s]);
    return std::sqrt(total / static_cast<double>(settings.count ? settings.count : 10000));
}

// A whole number of cells of about the wanted size along a length; too many for any scene are as
// good as more.
std::uint32_t cells(double length, double size) {
    return static_cast<std::uint32_t>(std::clamp(std::round(length / size), 1.0, 1e9));
}

// The lengths of a curved surface along u and v: those of its middle lines, which have the area of
// the whole for a product.
glm::dvec2 curve_lengths(const Curve& curve, double area) {
    constexpr int steps = 64;
    glm::dvec2 length(0);
    for (int k = 0; k < steps; ++k) {
        const double from = double(k) / steps, to = double(k + 1) / steps;
        length.x += glm::distance(curve_at(curve, from, 0.5).at, curve_at(curve, to, 0.5).at);
        length.y += glm::distance(curve_at(curve, 0.5, from).at, curve_at(curve, 0.5, to).at);
    }
    return length * std::sqrt(area / (length.x * length.y));
}

void choose_grid(const Scene& scene, const Surface& surface, double area, double size,
                 SurfaceGrid& grid) {
    const glm::dvec3& origin = scene.positions[surface.corner[0]];
    if (surface.is_curved()) {
        const glm::dvec2 length = curve_lengths(scene.curves[surface.curve], area);
        grid.nu = cells(length.x, size);
        grid.nv = cells(length.y, size);
    } else if (surface.shape() == Shape::triangle) {
        // n² similar triangles of about size².
        grid.nu = grid.nv = cells(std::sqrt(area), size);
    } else {
        grid.nu = cells(glm::distance(origin, scene.positions[surface.corner[1]]), size);
        grid.nv = cells(glm::distance(origin, scene.positions[surface.corner_v()]), size);
    }
}

// Which patches there are, without their values: what is found to be too many takes no memory.
struct Division {
    Patches patches;
    std::uint64_t count = 0;
};

// Divides the scene with cells of about one size (0: as the surfaces say).
Division divide(const Scene& scene, const PatchSettings& settings, const std::vector<double>& areas,
                double size) {
    Patches patches;
    patches.bands = scene.bands;
    patches.size = size;
    patches.grids.resize(scene.surfaces.size());
    bool asked = settings.size > 0 || settings.count > 0;

    // Let surfaces finer than the wanted size share patches.
    std::vector<std::uint32_t> cluster_of(scene.surfaces.size(), none);
    if (patches.size > 0 && settings.clusters)
        patches.clusters = grow_clusters(scene, areas, patches.size, settings.crease, cluster_of);

    // Number the patches surface by surface, fronts before backs.
    std::vector<SurfaceGrid> of_cluster(patches.clusters);
    std::uint64_t next = 0;
    constexpr std::uint64_t far_too_many = std::uint64_t(1) << 60;
    auto number = [&](SurfaceGrid& grid, int side_count, std::uint64_t cell_count) {
        next = std::min(next, far_too_many);
        grid.front = static_cast<std::uint32_t>(next);
        next += cell_count;
        if (side_count == 2) {
            grid.back = static_cast<std::uint32_t>(next);
            next += cell_count;
        }
    };
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        SurfaceGrid& grid = patches.grids[s];
        if (cluster_of[s] != none) {
            SurfaceGrid& shared = of_cluster[cluster_of[s]];
            if (shared.front == none)
                number(shared, sides(scene, surface), 1);
            grid = shared;
            continue;
        }
        if (surface.grid_u && surface.grid_v && !asked) {
            grid.nu = surface.grid_u;
            grid.nv = surface.grid_v;
        } else {
            choose_grid(scene, surface, areas[s], patches.size, grid);
        }
        number(grid, sides(scene, surface), static_cast<std::uint64_t>(grid.nu) * grid.nv);
    }

    return {std::move(patches), next};
}

}  // namespace

Patches make_patches(const Scene& scene, const PatchSettings& settings) {
    if (scene.surfaces.empty())
        throw Error(Fault::input, scene.file.string() + ": nothing with area in the scene");
    std::vector<double> areas(scene.surfaces.size());
    for (std::size_t s = 0; s < areas.size(); ++s)
        areas[s] = surface_area(scene, scene.surfaces[s]);
    double size = wanted_size(scene, settings, areas);
    Division division = divide(scene, settings, areas, size);
    // Whole cells and scraps make the count differ from the wanted one: draw nearer. Of slivers a
    // thousand times as long as a cell there may be far too many at first.
    constexpr int usual = 3, most = 24;
    for (int again = 0; again < most && settings.count > 0 && settings.size <= 0; ++again) {
        const double ratio =
            static_cast<double>(division.count) / static_cast<double>(settings.count);
        if (std::abs(ratio - 1) < 0.03 || (again >= usual && ratio < 2))
            break;
        size *= std::sqrt(ratio);
        division = divide(scene, settings, areas, size);
    }
    if (division.count > 0x7fffffffull)
        throw Error(Fault::memory, scene.file.string() + ": cells of " + std::to_string(size) +
                                       " m make more than 2^31 patches; choose a larger size");
    set_patch_values(scene, areas, static_cast<std::size_t>(division.count), division.patches);
    return std::move(division.patches);
}

std::vector<PatchPlace> patch_places(const Scene& scene, const Patches& patches) {
    return patch_places(scene, patches, 0, patches.count());
}

std::vector<PatchPlace> patch_places(const Scene& scene, const Patches& patches, std::size_t first,
                                     std::size_t end) {
    std::vector<PatchPlace> places(end - first);
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const SurfaceGrid& grid = patches.grids[s];
        const std::size_t cells = static_cast<std::size_t>(grid.nu) * grid.nv;
        const glm::dvec3 normal = surface_normal(scene, surface);
        const double equal =
            surface.is_curved() ? 0 : surface_area(scene, surface) / static_cast<double>(cells);
        for (std::uint32_t side : {grid.front, grid.back}) {
            if (side == none || side >= end || side + cells <= first)
                continue;
            const bool back = side == grid.back;
            for_each_cell(surface.shape(), grid, [&](const Cell& c) {
                const std::size_t patch = side + std::size_t(c.index);
                if (patch < first || patch >= end)
                    return;
                PatchPlace& place = places[patch - first];
                if (place.surface == none) {
                    place.surface = s;
                    place.iu = c.iu;
                    place.iv = c.iv;
                    place.back = back;
                }
                if (surface.is_curved()) {
                    place.centre = surface_point(scene, surface, c.centre_u, c.centre_v);
                    place.normal = surface_normal(scene, surface, c.centre_u, c.centre_v);
                    if (back)
                        place.normal = -place.normal;
                    return;
                }
                const double weight = equal / patches.area[patch];
                place.centre += weight * surface_point(scene, surface, c.centre_u, c.centre_v);
                place.normal += weight * (back ? -normal : normal);
            });
        }
    }
    for (PatchPlace& place : places)
        place.normal = glm::normalize(place.normal);
    return places;
}

}  // namespace parallux
