#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "parallux/patches.h"

// The independent judge of scenes with mirrors and glass: plain path tracing back from a point, by
// Embree, with materials of its own: reflection by evaluating GGX over the hemisphere, Fresnel by
// its own formula. Patches send alike from all of their area, as in a solution. No light without
// area but suns with a disc, which are part of the sky.

namespace parallux {

/// Mean and its standard error, a band.
struct PathEstimate {
    std::array<double, max_bands> mean{}, error{};
};

struct PathSettings {
    std::uint64_t paths = 10'000;
    std::uint64_t seed = 1;
    unsigned threads = 0;
};

/// Irradiance of each patch's diffuse part, W/m², as Solution has it, patch by patch.
std::vector<PathEstimate> traced_irradiance(const Scene& scene, const Patches& patches,
                                            const PathSettings& settings);

/// Radiance that is seen from a point along a unit direction, W/(m² sr).
PathEstimate traced_radiance(const Scene& scene, const Patches& patches, const glm::dvec3& from,
                             const glm::dvec3& direction, const PathSettings& settings);

}  // namespace parallux
