#pragma once

#include "solve/group.h"
#include "solve/run.h"

namespace parallux {

/// Sends batch after batch of line bundles (or of independent lines) through the scene; within a
/// batch all work from one snapshot of the unshot energy. The unshot power of the first shots is
/// the emission, spread evenly over the lines. Goes on behind the bundles that the group's pass has
/// done.
void global_pass(const Run& run, Group& group);

}  // namespace parallux
