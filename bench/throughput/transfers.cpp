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
    set_emission(run, first_shot(run), state_);
}

void Transfers::batch(const std::function<void()>& trace) {
    const Watch share_watch;
    share_unshot(state_, case_.patches, plan_.cell, settings_.batch, plan_.threads);
    double once = share_watch.seconds();

    const Watch trace_watch;
    trace();
    measured_.seconds += trace_watch.seconds();

    LineCounts counts;
    for (WorkerTotals& totals : banks_.all_totals())
        counts += std::exchange(totals.counts, {});
    measured_.counts += counts;
    const Watch merge_watch;
    merge(state_, case_.patches, banks_.banks(), banks_.all_totals(), plan_.threads);
    once += merge_watch.seconds();
    measured_.seconds +=
        once * static_cast<double>(counts.lines) / (settings_.batch * case_.lines_per_bundle);
}

Measured Transfers::result() const {
    Measured result = measured_;
    result.exits = state_.exits;
    return result;
}

}  // namespace parallux::throughput
