#pragma once

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

/// Finds direct light locally, as the settings want it: from the emitting patches by rays or by
/// exact form factors, from lights without area by shadow rays. Then shoots again from the patches
/// with most unshot power, `shots` times. What no shot took, and what the patches reflect, is left
/// unshot for the pass, which begins with settle().
DirectLight first_shot(const Run& run);

}  // namespace parallux
