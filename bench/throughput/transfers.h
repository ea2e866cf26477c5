#pragma once

#include <functional>

#include "solve/direct_light.h"
#include "solve/plan.h"
#include "throughput/engine.h"
#include "transfer/banks.h"

namespace parallux::throughput {

/// The project's own transfers for lists that come from elsewhere: the state of one solve, one
/// snapshot after the other. Its set-up is not timed.
class Transfers {
public:
    Transfers(const Case& of, unsigned threads);

    /// One batch: lets `trace` call follow() from its workers, then merges. Of merging, which is
    /// done once a batch however few lines it has, only the part that falls to these lines in a
    /// whole batch of the bundle engine is charged.
    void batch(const std::function<void()>& trace);

    void follow(const IntersectionLists& lists, unsigned worker) {
        exchange(lists, state_, Direction::bidirectional, {}, banks_.of(worker), banks_.shared(),
                 banks_.totals(worker));
    }

    Measured result() const;
    const Plan& plan() const { return plan_; }

private:
    void merge_batch();

    const Case& case_;
    SolveSettings settings_;
    Plan plan_;
    Banks banks_;
    TransferState state_;
    DirectLight direct_;
    Measured measured_;
};

}  // namespace parallux::throughput
