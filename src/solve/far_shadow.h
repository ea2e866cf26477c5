#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "lines/ray_scene.h"

namespace parallux {

/// Whether anything hides what lies far away from a point of a surface, copies of a scene that
/// repeats included: those up to most_copies periods away.
class FarShadow {
public:
    /// Keeps references to both.
    FarShadow(const RayScene& rays, const Scene& scene);

    bool blocked(const glm::dvec3& point, const glm::dvec3& toward, std::uint32_t surface) const;

private:
    const RayScene& rays_;
    Bounds bounds_;
    glm::dvec3 up_;
    double top_ = 0;                    // of the scene, along up
    double far_;                        // farther than the scene, or its copies, reach
    std::array<glm::dvec3, 2> period_;  // zero: none
    std::array<glm::dvec3, 2> along_;   // place in periods: dot products with these
    std::array<glm::dvec2, 2> extent_;  // the scene's least and most place
};

}  // namespace parallux
