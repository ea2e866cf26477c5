#pragma once

#include "solve/direct_light.h"
#include "solve/pass.h"

namespace parallux {

/// The result of a run: irradiance H = direct + factor · received / area, radiosity B = E + ρ H,
/// and the balance. The factor adds what the global pass has left over; see Leftover. Takes the
/// memory of direct light, state and banks.
Solution gather(const Run& run, DirectLight& direct, const PassResult& pass, TransferState& state);

}  // namespace parallux
