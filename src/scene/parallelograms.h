#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/spectrum.h"

namespace parallux {

/// A triangle of one mesh: its welded corners, and the mesh's own vertices (which carry the
/// attributes and may differ where the corners are one).
struct MeshTriangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> vertex{};
};

/// The other half of a triangle's parallelogram. The apex is the corner off the shared edge.
struct Partner {
    std::uint32_t triangle = none;
    std::uint8_t apex = 0;        ///< of this triangle
    std::uint8_t other_apex = 0;  ///< of the partner
};

/// Whether attributes too are affine over the parallelogram that two triangles would make.
using SameAttributes =
    std::function<bool(const MeshTriangle&, int apex, const MeshTriangle&, int other_apex)>;

/// One entry a triangle: who completes it to a parallelogram, if anyone does. Partners name each
/// other. They share an edge in opposite senses and their fourth corner lies within rounding of a
/// float file of where a parallelogram has it. Linear in the triangles.
std::vector<Partner> find_parallelograms(const std::vector<glm::dvec3>& positions,
                                         const std::vector<MeshTriangle>& triangles,
                                         const SameAttributes& same_attributes);

}  // namespace parallux
