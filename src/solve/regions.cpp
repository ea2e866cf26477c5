#include "solve/regions.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace parallux {

namespace {

using Key = std::uint64_t;

// Cuts the scene into cubes, so many along its longest side, and tells patches apart by them.
class Cutter {
public:
    Cutter(const Scene& scene, std::uint32_t cubes) : scene_(scene), cubes_(cubes) {
        const Bounds bounds = scene_bounds(scene);
        const glm::dvec3 size = bounds.high - bounds.low;
        low_ = bounds.low;
        side_ = std::max({size.x, size.y, size.z}) / cubes;
        objects_.resize(scene.objects.size());
        for (const Surface& surface : scene.surfaces)
            for (std::uint32_t corner : surface.corner)
                if (corner != none)
                    objects_[surface.object].add(scene.positions[corner]);
    }

    // Calls visit(patch, key) for the cells of a surface, both sides.
    template <class Visit>
    void for_cells(const Surface& surface, const SurfaceGrid& grid, Visit&& visit) const {
        const glm::dvec3 p = scene_.positions[surface.corner[0]];
        const glm::dvec3 u = scene_.positions[surface.corner[1]] - p;
        const glm::dvec3 v = scene_.positions[surface.corner_v()] - p;
        const bool small = objects_[surface.object].extent() <= side_;
        const std::uint32_t cells = grid.nu * grid.nv, way = facing(glm::cross(u, v));
        const Key front = Key(surface.object) << 32 | Key(small ? 0 : way) << 24;
        const Key back = Key(surface.object) << 32 | Key(small ? 1 : way ^ 1) << 24;
        std::uint32_t cell = 0;
        for (std::uint32_t iv = 0; iv < grid.nv; ++iv) {
            const bool triangle = surface.shape() == Shape::triangle;
            const std::uint32_t in_row = triangle ? 2 * (grid.nv - iv) - 1 : grid.nu;
            for (std::uint32_t k = 0; k < in_row; ++k, ++cell) {
                const double along = (k + (triangle ? 2.0 / 3 : 0.5)) / (triangle ? 2.0 : 1.0);
                const double across = iv + (triangle ? 1.0 / 3 : 0.5);
                const Key cube =
                    small ? 0 : cube_of(p + along / grid.nu * u + across / grid.nv * v);
                visit(grid.front + cell, front | cube);
                if (grid.back != none)
                    visit(grid.front + cells + cell, back | cube);
            }
        }
    }

private:
    struct Box {
        glm::dvec3 low{INFINITY}, high{-INFINITY};

        void add(const glm::dvec3& p) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        double extent() const {
            const glm::dvec3 size = high - low;
            return std::max({size.x, size.y, size.z});
        }
    };

    // The axis that a normal is nearest to, and its sense.
    static std::uint32_t facing(const glm::dvec3& normal) {
        const glm::dvec3 size = glm::abs(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        return static_cast<std::uint32_t>(2 * axis) + (normal[axis] < 0 ? 1 : 0);
    }

    Key cube_of(const glm::dvec3& p) const {
        Key cube = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = side_ > 0 ? std::floor((p[axis] - low_[axis]) / side_) : 0;
            cube = cube << 8 | static_cast<Key>(std::clamp<double>(at, 0, cubes_ - 1));
        }
        return cube;
    }

    const Scene& scene_;
    std::uint32_t cubes_;
    glm::dvec3 low_;
    double side_;
    std::vector<Box> objects_;
};

// Patches are numbered surface by surface; later surfaces may share those of an earlier one.
template <class Visit>
void for_patches(const Scene& scene, const Patches& patches, const Cutter& cutter, Visit&& visit) {
    std::uint32_t next = 0;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        if (grid.front != next)
            continue;
        next += grid.nu * grid.nv * (grid.back == none ? 1 : 2);
        cutter.for_cells(scene.surfaces[s], grid, visit);
    }
}

}  // namespace

Regions make_regions(const Scene& scene, const Patches& patches) {
    Regions regions;
    regions.of.resize(patches.count());
    // Of few patches few regions: the system is solved for every group and band.
    const std::size_t wanted = std::clamp<std::size_t>(patches.count() / 64, 64, Regions::most);
    for (std::uint32_t cubes : {4u, 3u, 2u, 1u}) {
        const Cutter cutter(scene, cubes);
        std::map<Key, double> areas;
        for_patches(scene, patches, cutter,
                    [&](std::uint32_t patch, Key key) { areas[key] += patches.area[patch]; });
        if (areas.size() > wanted && cubes > 1)
            continue;
        // The largest are regions; should there be too many, all others are the last one together.
        std::vector<std::pair<double, Key>> order;
        for (const auto& [key, area] : areas)
            order.emplace_back(-area, key);
        std::sort(order.begin(), order.end());
        std::map<Key, std::uint8_t> number;
        for (std::size_t k = 0; k < order.size(); ++k)
            number[order[k].second] =
                static_cast<std::uint8_t>(std::min<std::size_t>(k, Regions::most - 1));
        regions.count =
            static_cast<std::uint32_t>(std::min<std::size_t>(order.size(), Regions::most));
        for_patches(scene, patches, cutter,
                    [&](std::uint32_t patch, Key key) { regions.of[patch] = number[key]; });
        break;
    }
    return regions;
}

}  // namespace parallux
