#pragma once

#include <memory>

#include "solve/group.h"
#include "solve/run.h"
#include "solve/shot_exact.h"

namespace parallux {

/// What exact first shots of all groups share; null where the plan wants none or nothing emits.
std::unique_ptr<ExactShot> prepare_exact(const Scene& scene, const Patches& patches,
                                         const RayScene* rays, const Plan& plan,
                                         Listener& listener);

/// Finds direct light locally, as the settings want it: from the emitting patches by rays or by
/// exact form factors, from lights without area by shadow rays. Then shoots again from the patches
/// with most unshot power, `shots` times. What no shot took, and what the patches reflect, is left
/// unshot for the pass, which begins with settle(). Goes on with the group's stage.
void first_shot(const Run& run, Group& group);

/// Sends a few rays, behind the first `done` of them, to see how much noise they leave in direct
/// light and how large the patches are that it falls on. Uses the banks and leaves them empty.
/// O(patches).
Trial try_rays(const Run& run, std::uint64_t& done);

}  // namespace parallux
