#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/lines.h"

namespace parallux {

/// On which side of each surface's plane every other surface lies: the same for all directions, so
/// that a bundle's depth order follows from signs alone. Halves of spheres are parted from others
/// by planes that touch the sphere. n² bytes; for scenes of few surfaces.
class PlaneSides {
public:
    static constexpr std::size_t most_surfaces = 256;

    explicit PlaneSides(const Scene& scene);

    /// The surfaces of a projection so that of two that overlap the one met first comes first, as
    /// far as their planes part them (M. Newell, R. Newell and T. Sancha, A solution to the hidden
    /// surface problem, 1972, without its splitting). What this leaves wrong must be found by the
    /// depths of the hits. O(n²).
    void order(const Projection& projection, const Scene& scene,
               std::vector<std::uint32_t>& surfaces) const;

private:
    // 1: all of b lies on the side that a's normal points to; -1: on the other; 0: on both, or in
    // the plane.
    std::int8_t side(std::size_t a, std::size_t b) const { return sides_[a * count_ + b]; }

    // How one half of a sphere lies to another surface.
    struct Beside {
        glm::dvec3 toward{0};  ///< of a plane that parts both, to the other; or 0
        bool within = false;   ///< the other lies in the sphere
    };
    static Beside beside(const Scene& scene, const Surface& ball, const Surface& other);
    // 1: half `ball` of a sphere comes before another surface, -1: after it, 0: nobody can tell.
    int half_order(const Scene& scene, std::size_t ball, std::size_t other,
                   const glm::dvec3& direction) const;

    std::size_t count_;
    std::vector<std::int8_t> sides_;
    std::vector<glm::dvec3> normals_;
    std::vector<std::vector<Beside>> beside_;  // of halves of spheres, by surface
};

}  // namespace parallux
