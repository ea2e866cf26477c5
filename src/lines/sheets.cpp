#include "lines/sheets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <glm/geometric.hpp>

#include "random.h"

namespace parallux {

namespace {

std::array<std::uint32_t, 4> sorted_corners(const Surface& surface) {
    std::array<std::uint32_t, 4> corners = surface.corner;
    std::sort(corners.begin(), corners.end());
    return corners;
}

}  // namespace

bool are_sheet(const Scene& scene, const Surface& a, const Surface& b) {
    // Corners say nothing of where a curved surface lies.
    return !a.is_curved() && !b.is_curved() && sorted_corners(a) == sorted_corners(b) &&
           glm::dot(surface_normal(scene, a), surface_normal(scene, b)) < 0;
}

std::shared_ptr<const std::vector<bool>> sheet_faces(const Scene& scene) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(scene.surfaces.size());
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        std::uint64_t key = 0;
        for (std::uint32_t corner : sorted_corners(scene.surfaces[s]))
            key = mix64(key ^ corner);
        keys.emplace_back(key, s);
    }
    std::sort(keys.begin(), keys.end());
    auto faces = std::make_shared<std::vector<bool>>(scene.surfaces.size(), false);
    for (std::size_t k = 0; k < keys.size(); ++k)
        for (std::size_t l = k + 1; l < keys.size() && keys[l].first == keys[k].first; ++l)
            if (are_sheet(scene, scene.surfaces[keys[k].second], scene.surfaces[keys[l].second]))
                (*faces)[keys[k].second] = (*faces)[keys[l].second] = true;
    return faces;
}

}  // namespace parallux
