#pragma once

#include <cstdint>

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

struct BrightestSettings {
    std::uint64_t shots = 0;  ///< at most so many; 0: no limit
    double until = 0;         ///< or until this share of all that was emitted is left unshot
    double rays = 0;  ///< of a shot with all that was emitted; others by their power, at least 64
};

/// Shoots from one patch after the other, always from the one with most unshot power (summed over
/// bands, the lowest number among equals), by local rays or, where the plan says so, by exact form
/// factors; what a patch reflects of what it receives is unshot in turn (M. Cohen, S. Chen,
/// J. Wallace and D. Greenberg, A progressive refinement approach to fast radiosity image
/// generation, SIGGRAPH 1988). O(patches) a shot, and its rays.
void shoot_brightest(const Run& run, DirectLight& direct, const BrightestSettings& settings);

}  // namespace parallux
