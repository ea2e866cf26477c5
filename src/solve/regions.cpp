#include "solve/regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "patches/patch_values.h"

namespace parallux {

namespace {

// Object, side, the way it faces, and the cube it lies in; the cube in the lowest bits, its
// coordinates' bits in turn (Morton's order), so that leaving out the last three joins eight.
using Key = std::uint64_t;
constexpr int levels = 7;
constexpr Key by_itself = Key(1) << 63;

// A grid of 2^levels cubes along the scene's longest side.
class Cubes {
public:
    explicit Cubes(const Bounds& bounds) : low_(bounds.low) {
        const glm::dvec3 size = bounds.high - bounds.low;
        side_ = std::max({size.x, size.y, size.z}) / (1 << levels);
    }

    Key key(const glm::dvec3& p) const {
        Key key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = side_ > 0 ? std::floor((p[axis] - low_[axis]) / side_) : 0;
            const auto cube = static_cast<Key>(std::clamp(at, 0.0, double((1 << levels) - 1)));
            for (int bit = 0; bit < levels; ++bit)
                key |= (cube >> bit & 1) << (3 * bit + axis);
        }
        return key;
    }

private:
    glm::dvec3 low_;
    double side_;
};

// The axis that a normal is nearest to, and its sense.
Key facing(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<Key>(2 * axis) + (normal[axis] < 0 ? 1 : 0);
}

// The objects of most area have numbers of their own; all others are one, 0.
std::vector<Key> object_numbers(const Scene& scene, std::size_t most) {
    std::vector<double> area(scene.objects.size(), 0);
    for (const Surface& surface : scene.surfaces)
        area[surface.object] += surface_area(scene, surface);
    std::vector<std::size_t> order(area.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return area[a] > area[b]; });
    std::vector<Key> numbers(area.size(), 0);
    for (std::size_t k = 0; k < std::min(order.size(), most); ++k)
        numbers[order[k]] = k + 1;
    return numbers;
}

// Sets the keys of a surface's cells, both sides.
void key_cells(const Scene& scene, const Surface& surface, const SurfaceGrid& grid, Key number,
               const Cubes& cubes, std::vector<Key>& keys) {
    if (surface.is_curved()) {
        for_each_cell(surface.shape(), grid, [&](const Cell& c) {
            const Key way = facing(surface_normal(scene, surface, c.centre_u, c.centre_v));
            const Key cube = cubes.key(surface_point(scene, surface, c.centre_u, c.centre_v));
            keys[grid.front + c.index] = (number << 4 | way) << (3 * levels) | cube;
            if (grid.back != none)
                keys[grid.back + c.index] = (number << 4 | 8 | (way ^ 1)) << (3 * levels) | cube;
        });
        return;
    }
    const glm::dvec3 p = scene.positions[surface.corner[0]];
    const glm::dvec3 u = scene.positions[surface.corner[1]] - p;
    const glm::dvec3 v = scene.positions[surface.corner_v()] - p;
    const Key way = facing(glm::cross(u, v)), object = number << 4;
    const bool triangle = surface.shape() == Shape::triangle;
    std::uint32_t cell = 0;
    for (std::uint32_t iv = 0; iv < grid.nv; ++iv) {
        const std::uint32_t in_row = triangle ? 2 * (grid.nv - iv) - 1 : grid.nu;
        for (std::uint32_t k = 0; k < in_row; ++k, ++cell) {
            const double along = (k + (triangle ? 2.0 / 3 : 0.5)) / (triangle ? 2.0 : 1.0);
            const double across = iv + (triangle ? 1.0 / 3 : 0.5);
            const Key cube = cubes.key(p + along / grid.nu * u + across / grid.nv * v);
            keys[grid.front + cell] = (object | way) << (3 * levels) | cube;
            if (grid.back != none)
                keys[grid.back + cell] = (object | 8 | (way ^ 1)) << (3 * levels) | cube;
        }
    }
}

std::vector<Key> keys_of(const Scene& scene, const Patches& patches, double large,
                         std::size_t objects) {
    const Cubes cubes(scene_bounds(scene));
    const std::vector<Key> numbers = object_numbers(scene, objects);
    std::vector<Key> keys(patches.count());
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        key_cells(scene, scene.surfaces[s], patches.grids[s], numbers[scene.surfaces[s].object],
                  cubes, keys);
    for (std::size_t patch = 0; patch < keys.size(); ++patch)
        if (patches.area[patch] >= large)
            keys[patch] = by_itself | patch;
    return keys;
}

Key joined(Key key, int level) {
    return key & by_itself ? key : key >> (3 * level) << (3 * level);
}

// Of every patch the number of what it is joined in, and how many those are.
std::uint32_t join(const Scene& scene, const Patches& patches, std::size_t wanted,
                   std::vector<std::uint32_t>& of) {
    double area = 0;
    for (double one : patches.area)
        area += one;
    // Objects have two sides and face six ways: so few that the coarsest cubes suffice.
    const std::vector<Key> keys =
        keys_of(scene, patches, 0.5 * area / static_cast<double>(wanted), wanted / 16);
    std::vector<Key> different = keys;
    std::sort(different.begin(), different.end());
    int level = 0;
    for (;; ++level) {
        for (Key& key : different)
            key = joined(key, level);
        different.erase(std::unique(different.begin(), different.end()), different.end());
        if (different.size() <= wanted || level == levels)
            break;
    }
    of.resize(patches.count());
    for (std::size_t patch = 0; patch < keys.size(); ++patch)
        of[patch] = static_cast<std::uint32_t>(
            std::lower_bound(different.begin(), different.end(), joined(keys[patch], level)) -
            different.begin());
    return static_cast<std::uint32_t>(different.size());
}

}  // namespace

Regions make_regions(const Scene& scene, const Patches& patches, std::size_t wanted,
                     std::size_t groups) {
    Regions regions;
    regions.count = join(scene, patches, wanted, regions.of);
    std::vector<std::uint32_t> group;
    regions.groups = join(scene, patches, groups, group);
    regions.sizes.resize(regions.count, 0);
    regions.group.resize(regions.count, 0);
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        ++regions.sizes[regions.of[patch]];
        regions.group[regions.of[patch]] = group[patch];
    }
    return regions;
}

}  // namespace parallux
