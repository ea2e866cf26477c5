#pragma once

#include <glm/vec2.hpp>

#include "parallux/scene.h"

namespace parallux {

enum class Wrap { repeat, clamp_v };  ///< clamp_v: repeats along u only

/// Bilinear value at (u, v); texel centres lie at half-integers. Coordinates that are no number
/// count as 0.
glm::vec3 texture_at(const Texture& texture, glm::vec2 uv, Wrap wrap);

}  // namespace parallux
