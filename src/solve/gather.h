#pragma once

#include <vector>

#include "parallux/solve.h"
#include "solve/first_shot.h"
#include "solve/global_pass.h"
#include "solve/plan.h"

namespace parallux {

/// The result of a run: irradiance H = (direct + κ · global) / area, radiosity B = E + ρ H, and the
/// balance. κ spreads what the global pass has not finished, be it unshot at the end, emission that
/// fewer or more lines carried than expected, or bundles of a stopped run: per band,
/// κ = planned emission / (absorbed + escaped).
Solution gather(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                const Plan& plan, const DirectLight& direct,
                const std::vector<std::int64_t>& planned, const PassResult& pass,
                TransferState& state);

}  // namespace parallux
