#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallux/scene.h"

namespace parallux {

/// An edge of a facet that lies on its surface's own edge, and the corners of others on it.
struct Rim {
    std::uint32_t surface, from, to;
    glm::dvec2 uv_from, uv_to;
    struct Taken {
        double along;
        std::uint32_t corner;
    };
    std::vector<Taken> taken = {};
    bool parted = false;  ///< its facet has been parted at them

    std::uint32_t end_of(std::size_t k) const {
        return k + 1 < taken.size() ? taken[k + 1].corner : to;
    }
};

/// The limits within which facets stay.
struct FacetLimits {
    double chord, bend;  ///< metres, and of a chord's own length
    double same_place;   ///< metres
};

/// Rims take up every corner of others that lies on them: curved ones any, planar ones those of
/// curved surfaces. The first `curved` are of curved surfaces. O(n log n).
void take_corners(const Scene& scene, const std::vector<glm::dvec3>& positions,
                  const FacetLimits& limits, std::size_t curved, std::vector<Rim>& rims);

}  // namespace parallux
