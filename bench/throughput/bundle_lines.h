#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "parallux/lines.h"

namespace parallux::throughput {

/// The lines of a bundle that the projector goes through: columns left … left + columns - 1.
struct LineRectangle {
    std::int32_t left = 0, top = 0, columns = 0, rows = 0;

    std::uint64_t lines() const { return static_cast<std::uint64_t>(columns) * rows; }
};

/// The same rectangle as Projector::project() finds, about the same centre. O(positions).
LineRectangle rectangle_of(const Scene& scene, const glm::dvec3& centre, const Bundle& bundle);

/// Mean area, in m², of the rectangles of a run's bundles (of the first 64, if there are more).
double mean_rectangle(const Scene& scene, std::uint64_t bundles);

}  // namespace parallux::throughput
