#include "solve/global_pass.h"

#include <algorithm>
#include <utility>

#include "random.h"
#include "solve/line_sweep.h"

namespace parallux {

namespace {

// Bundles whose emission is still unshot: how far the reflected light lags behind, in the band
// where it lags most. Band totals are integers, so that this is the same on any number of threads.
double lag(const TransferState& state, std::uint64_t done) {
    return Leftover::held(state) * static_cast<double>(done);
}

// Of how many pairs one is kept: more, and of all bundles, where light lags so far behind that much
// will be left over.
std::uint64_t stride(const Plan& plan, const TransferState& state, std::uint64_t done) {
    if (lag(state, done) > Leftover::much * static_cast<double>(plan.passing()))
        return plan.keeping.stride;
    return done < plan.keeping.first ? plan.keeping.first_stride : 0;
}

// How many bundles work from the next snapshot. A bounce takes about two batches: batches grow to
// the wanted size while the light keeps up, shrink where it lags by more than 1/32 of the run
// (white walls, narrow gaps), and shrink towards the end, so that little is left unshot there.
std::uint32_t next_batch(const Plan& plan, double lagging, std::uint64_t done, std::uint32_t last) {
    std::uint64_t emitting = plan.passing() - plan.closing;
    if (done >= emitting)
        return 1;
    bool behind = lagging > static_cast<double>(plan.passing()) / 32;
    std::uint64_t wanted = behind ? last / 2 : std::min(2 * last, plan.batch);
    std::uint64_t left = emitting - done;
    wanted = std::min(wanted, left / 8);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, left));
}

}  // namespace

namespace {

// All that a pass is before its first batch, which the caller settles.
void begin_pass(const Run& run, Group& group) {
    settle(run, group.direct);
    TransferState& state = group.state;
    state.emission = emission_of(run.patches, group.direct);
    state.watts_per_quantum = carried_quantum(run, state.emission);
    state.dither = static_cast<std::uint32_t>(mix64(run.settings.seed));
    std::vector<double> planned;
    for (std::int64_t quanta : group.direct.unshot)
        planned.push_back(static_cast<double>(quanta) * run.plan.watts_per_quantum);
    group.pass.leftover =
        std::make_unique<Leftover>(run.patches, *run.regions, planned, run.plan.threads);
}

}  // namespace

void global_pass(const Run& run, Group& group) {
    const Plan& plan = run.plan;
    TransferState& state = group.state;
    PassResult& pass = group.pass;
    const bool bundles = run.settings.method == Method::bundles;
    const bool resumed = pass.batch > 0;
    if (!resumed)
        begin_pass(run, group);
    LineSweep sweep(run, state, run.settings.direction, emission_quanta(plan, state));
    // Light that goes from bundle to bundle must meet a direction again as often as if all were
    // independent: of a lattice that has each but once, a run of D bundles is off by some 1/D.
    const BundleSettings lattice{run.settings.seed, plan.passing(), run.settings.directions,
                                 plan.spacing, true};
    sweep.keep(pass.leftover->ways);
    const std::uint64_t emitting = plan.passing() - plan.closing;
    // What the next batch's exits carry is set by the merge before it, in one walk over the
    // patches: its size goes by the light that the merge before that has seen.
    auto merge_for = [&](std::uint32_t next) {
        pass.batch = next;
        const bool emits = pass.bundles < emitting;
        merge(state, run.patches, run.banks.banks(), run.banks.all_totals(),
              {plan.cell, next, emits ? emission_quanta(plan, state) : 0}, plan.threads);
    };
    if (!resumed)
        merge_for(next_batch(plan, 0, 0, 1));
    while (pass.bundles < plan.passing()) {
        // Emission ends before the lines do.
        if (pass.bundles >= emitting)
            sweep.darken_sky();
        pass.leftover->ways.keep_one_of(stride(plan, state, pass.bundles));
        if (bundles) {
            sweep.bundles(lattice, pass.bundles, pass.batch);
        } else {
            std::uint64_t first = pass.bundles * plan.lines_a_unit;
            std::uint64_t end = std::min(plan.lines, first + pass.batch * plan.lines_a_unit);
            sweep.lines(first, end - first);
        }
        for (WorkerTotals& totals : run.banks.all_totals())
            pass.counts += std::exchange(totals.counts, {});
        const double behind = lag(state, pass.bundles);
        pass.bundles += pass.batch;
        merge_for(next_batch(plan, behind, pass.bundles, pass.batch));
        if (!run.listener.go_on(
                bundles ? "bundles" : "lines",
                static_cast<double>(pass.bundles) / static_cast<double>(plan.bundles),
                pass.counts.lines))
            break;
    }
    pass.done = std::min(1.0, static_cast<double>(pass.bundles) / static_cast<double>(emitting));
    pass.whole = pass.bundles == plan.passing();
}

}  // namespace parallux
