#pragma once

#include "solve/direct_light.h"
#include "solve/pass.h"
#include "solve/run.h"

namespace parallux {

/// Ends a pass: states its balance, counts the lines that left each patch, and turns what was
/// received into irradiance, factor · received / area. The factor adds what the pass has left over;
/// see Leftover. Gives back the memory of what was sent,
/// carried and kept.
void end_pass(const Run& run, const DirectLight& direct, TransferState& state, PassResult& pass);

}  // namespace parallux
