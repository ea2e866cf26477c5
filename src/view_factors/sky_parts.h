#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "parallux/factors.h"

namespace parallux {

/// Which part of the sky a direction looks at. Rows of equal height from the horizon to a cap about
/// the zenith; in a row, parts go from north by east, the first one centred on north, so that part
/// k + 1 is patch k + 1 of Radiance's gendaymtx.
class SkyDome {
public:
    /// `north` is made orthogonal to the unit `up`; where it is along it, another one is chosen.
    SkyDome(SkyParts parts, const glm::dvec3& up, const glm::dvec3& north);

    std::uint32_t count() const { return count_; }
    /// Part 0 … count - 1; count: at or below the horizon.
    std::uint32_t part(const glm::dvec3& direction) const;

private:
    std::uint32_t split_, count_;  // rows and parts of Tregenza's are each cut in so many; 0: none
    glm::dvec3 up_, north_, east_;
};

}  // namespace parallux
