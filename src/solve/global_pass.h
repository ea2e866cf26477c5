#pragma once

#include <functional>

#include "lines/ray_scene.h"
#include "parallux/solve.h"
#include "solve/leftover.h"
#include "solve/plan.h"
#include "transfer/delta_banks.h"

namespace parallux {

/// What the global pass did.
struct PassResult {
    Leftover leftover;
    LineCounts counts;
    std::uint64_t bundles = 0;  ///< done of those planned
    double done = 0;            ///< share of the planned emission that was sent
    bool whole = false;         ///< all bundles are done
};

/// Sends batch after batch of line bundles (or of independent lines) through the scene; within a
/// batch all work from one snapshot of the unshot energy. `go_on(bundles done, lines done)` false
/// stops after the batch.
PassResult global_pass(const Scene& scene, const Patches& patches, const RayScene* rays,
                       const SolveSettings& settings, const Plan& plan, TransferState& state,
                       DeltaBanks& banks,
                       const std::function<bool(std::uint64_t, std::uint64_t)>& go_on);

}  // namespace parallux
