#pragma once

#include <vector>

#include "parallux/solve.h"
#include "solve/first_shot.h"
#include "solve/global_pass.h"
#include "solve/plan.h"

namespace parallux {

/// The result of a run: irradiance H = (direct + factor · received) / area, radiosity B = E + ρ H,
/// and the balance. The factor adds what the global pass has left over; see Leftover.
Solution gather(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                const Plan& plan, const DirectLight& direct,
                const std::vector<std::int64_t>& planned, const PassResult& pass,
                TransferState& state);

}  // namespace parallux
