#pragma once

#include <chrono>

#include "parallux/factors.h"
#include "view_factors/memory.h"
#include "view_factors/pair_sweep.h"

namespace parallux {

/// Follows the bundles of a run, group by group, looks at memory and tells of progress. Keeps
/// references to all; `result` has groups, threads and line spacing already, and gets bundles,
/// groups that were begun, what memory was foretold, and whether it was stopped.
class Counting {
public:
    Counting(PairSweep& sweep, PairCounts& counts, const FactorMemory& memory,
             const FactorSettings& settings, const ProgressCallback& progress, Factors& result);

    void run();

private:
    void follow_group(std::uint32_t group);
    void look_at_memory();
    void report();

    PairSweep& sweep_;
    PairCounts& counts_;
    const FactorMemory& memory_;
    const FactorSettings& settings_;
    const ProgressCallback& progress_;
    Factors& result_;
    std::uint64_t a_group_, all_ = 0, look_ = 1;
    double pairs_ = 0, looked_at_ = 0;  // at the last look
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace parallux
