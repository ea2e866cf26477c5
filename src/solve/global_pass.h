#pragma once

#include "solve/direct_light.h"
#include "solve/pass.h"
#include "solve/run.h"

namespace parallux {

/// Sends batch after batch of line bundles (or of independent lines) through the scene; within a
/// batch all work from one snapshot of the unshot energy. The unshot power of the first shots is
/// the emission, spread evenly over the lines.
PassResult global_pass(const Run& run, DirectLight& direct, TransferState& state);

}  // namespace parallux
