#pragma once

#include <cstdint>
#include <span>

#include "solve/group.h"
#include "solve/run.h"

namespace parallux {

/// Follows the gathering bundles, a lattice of their own: every exit carries what its patch sends
/// (its emission in the pass, and what it reflects of the irradiance the pass has found), and a
/// patch's irradiance becomes the mean of what is carried at the other ends of the lines that leave
/// it. The sky stands at the ends of lines that leave the scene, an inert back is dark. What the
/// first shots brought is not gathered. Dividing by the lines that really left takes the noise of
/// their number away, and the error of the pass is smoothed by one more bounce. Moves no energy:
/// the balance remains the pass's. Patches that no line leaves keep what the pass found. The `dark`
/// ones send nothing. Goes on behind the bundles that the group has gathered.
void closing_gather(const Run& run, Group& group, std::span<const std::uint32_t> dark);

}  // namespace parallux
