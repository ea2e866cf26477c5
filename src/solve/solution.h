#pragma once

#include "solve/direct_light.h"
#include "solve/pass.h"
#include "solve/run.h"

namespace parallux {

/// Ends a pass: states its balance, counts the lines that left each patch, and turns what was
/// received into irradiance, factor · received / area. The factor adds what the pass has left over;
/// see Leftover. Gives back the memory of what was sent and carried.
void end_pass(const Run& run, const DirectLight& direct, TransferState& state, PassResult& pass);

/// The result of a run: irradiance H = direct + the pass's, radiosity B = E + ρ H. Takes the memory
/// of direct light and pass.
Solution solution_of(const Run& run, DirectLight& direct, PassResult& pass);

}  // namespace parallux
