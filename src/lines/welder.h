#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/geometric.hpp>

#include "parallux/scene.h"

namespace parallux {

/// Gives nearly equal positions one number: that of a planar surface's corner where there is one.
class Welder {
public:
    Welder(const Scene& scene, std::vector<glm::dvec3>& positions, double tolerance)
        : positions_(positions), tolerance_(tolerance) {
        std::vector<bool> known(positions.size());
        for (const Surface& surface : scene.surfaces)
            for (std::uint32_t corner : surface.corner)
                if (!surface.is_curved() && corner != none && !known[corner]) {
                    known[corner] = true;
                    cells_.emplace(key(positions[corner]), corner);
                }
    }

    std::uint32_t weld(const glm::dvec3& p) {
        // The cells that the box about it touches: one as a rule.
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 way(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            auto [begin, end] = cells_.equal_range(key(p + tolerance_ * way));
            for (; begin != end; ++begin)
                if (glm::distance(positions_[begin->second], p) <= tolerance_)
                    return begin->second;
        }
        const auto number = static_cast<std::uint32_t>(positions_.size());
        positions_.push_back(p);
        cells_.emplace(key(p), number);
        return number;
    }

private:
    std::uint64_t key(const glm::dvec3& p) const {
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis)
            key = (key ^ static_cast<std::uint64_t>(
                             static_cast<std::int64_t>(std::floor(p[axis] / (16 * tolerance_))))) *
                  0x9E3779B97F4A7C15u;
        return key;
    }

    std::vector<glm::dvec3>& positions_;
    double tolerance_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> cells_;
};

}  // namespace parallux
