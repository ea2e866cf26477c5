#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "random.h"

namespace parallux {

/// Uniform in the unit disk; `square` is its squared distance from the centre, below 1.
glm::dvec2 uniform_disk(Random& random, double& square);

/// Uniform on the unit sphere.
glm::dvec3 uniform_direction(Random& random);

/// Point 0 … count - 1 of a spherical Fibonacci lattice (R. Swinbank and R. J. Purser, Fibonacci
/// grids: a novel approach to global modelling, QJRMS 132, 2006).
glm::dvec3 fibonacci_direction(std::uint64_t point, std::uint64_t count);

/// Where `index` goes in a permutation of 0 … count - 1 that the seed chooses. O(1).
std::uint64_t shuffled(std::uint64_t index, std::uint64_t count, std::uint64_t seed);

/// Unit x and y with x × y = direction.
void frame_across(const glm::dvec3& direction, glm::dvec3& x, glm::dvec3& y);

}  // namespace parallux
