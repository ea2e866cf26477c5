#include "throughput/transfers.h"

#include <utility>

#include "solve/first_shot.h"
#include "solve/pass.h"
#include "solve/run.h"

namespace parallux::throughput {

Transfers::Transfers(const Case& of, unsigned threads)
    : case_(of),
      settings_(of.settings(threads)),
      plan_(make_plan(of.scene, of.patches, settings_)),
      banks_(of.patches.count(), of.patches.bands, plan_.threads, plan_.bank_bytes),
      state_(dark_state(of.patches, plan_.watts_per_quantum)) {
    const ProgressCallback nobody;
    Listener listener(nobody, 0);
    const Run run{of.scene, of.patches, settings_, plan_, nullptr, banks_, listener};
    Group group;
    first_shot(run, group);
    direct_ = std::move(group.direct);
    settle(run, direct_);
    state_.emission = emission_of(of.patches, direct_);
    state_.watts_per_quantum = carried_quantum(run, state_.emission);
    merge_batch();
}

void Transfers::merge_batch() {
    merge(state_, case_.patches, banks_.banks(), banks_.all_totals(),
          {plan_.cell, settings_.batch, emission_quanta(plan_, state_)}, plan_.threads);
}

void Transfers::batch(const std::function<void()>& trace) {
    const Watch trace_watch;
    trace();
    measured_.seconds += trace_watch.seconds();

    LineCounts counts;
    for (WorkerTotals& totals : banks_.all_totals())
        counts += std::exchange(totals.counts, {});
    measured_.counts += counts;
    const Watch merge_watch;
    merge_batch();
    measured_.seconds += merge_watch.seconds() * static_cast<double>(counts.lines) /
                         (settings_.batch * case_.lines_per_bundle);
}

Measured Transfers::result() const {
    Measured result = measured_;
    for (std::size_t patch = 0; patch < case_.patches.count(); ++patch)
        result.exits.push_back(static_cast<std::uint64_t>(banks_.exits(patch)));
    return result;
}

}  // namespace parallux::throughput
