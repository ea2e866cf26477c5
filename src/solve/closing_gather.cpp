#include "solve/closing_gather.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel.h"
#include "random.h"
#include "solve/line_sweep.h"
#include "solve/power.h"
#include "transfer/merge.h"

namespace parallux {

namespace {

// Parted from the pass's bundles by its seed.
constexpr std::uint64_t gather_key = 0x67617468657200ull;

// A power of two of quanta per W/m², so that the brightest exit carries as many as it may.
double quanta_per_exitance(const Run& run, const Emission& emission, const PassResult& pass) {
    std::vector<double> worker_most(run.plan.threads, 0);
    parallel_for(run.plan.threads, pass.irradiance.size(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     double most = worker_most[worker];
                     for (std::size_t k = begin; k < end; ++k)
                         most = std::max(most, sent_by_exit(run, emission, pass, k));
                     worker_most[worker] = most;
                 });
    double most = *std::max_element(worker_most.begin(), worker_most.end());
    for (std::uint32_t band = 0; band < run.patches.bands; ++band)
        most = std::max(most, pi * sky_bound(run.scene.sky, band));
    int exponent = 0;
    std::frexp(most, &exponent);
    return most > 0 ? std::ldexp(1.0, std::ilogb(most_carried) - exponent) : 1;
}

// Sets what exits carry, in whole quanta, up or down by a dither that differs every time: right in
// the mean, however dim the patch.
void load_exits(const Run& run, const Emission& emission, const PassResult& pass, double unit,
                TransferState& state) {
    const std::uint32_t bands = state.bands;
    state.carried.resize(run.patches.count() * lanes(bands), 0);
    state.dither += dither_merge;
    parallel_for(run.plan.threads, run.patches.count(), 4096,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t patch = begin; patch < end; ++patch)
                         for (std::uint32_t band = 0; band < bands; ++band) {
                             const std::uint32_t dither =
                                 static_cast<std::uint32_t>(patch) * dither_patch +
                                 band * dither_band + state.dither;
                             state.carried[patch * lanes(bands) + band] = static_cast<std::int32_t>(
                                 unit * sent_by_exit(run, emission, pass, patch * bands + band) +
                                 static_cast<double>(dither >> 1) * 0x1p-31);
                         }
                 });
}

// The mean of what was carried at the other ends, where there are any.
void take_means(const Run& run, double unit, PassResult& pass) {
    const std::uint32_t bands = run.patches.bands;
    auto take = [&](std::size_t patch) {
        const std::int64_t exits = run.banks.exits(patch);
        if (exits == 0)
            return;
        pass.crossings[patch] += static_cast<std::uint64_t>(exits);
        const double each = 1 / (unit * static_cast<double>(exits));
        for (std::uint32_t band = 0; band < bands; ++band)
            pass.irradiance[patch * bands + band] =
                static_cast<float>(each * static_cast<double>(run.banks.received(patch, band)));
    };
    parallel_for(run.plan.threads, run.patches.count(), 4096,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t patch = begin; patch < end; ++patch)
                         take(patch);
                 });
}

}  // namespace

void closing_gather(const Run& run, Group& group, std::span<const std::uint32_t> dark) {
    const Plan& plan = run.plan;
    TransferState& state = group.state;
    PassResult& pass = group.pass;
    if (plan.gathering == 0 || !pass.whole)
        return;
    Emission emission = state.emission;
    emission.quanta = 1;
    const double unit = quanta_per_exitance(run, emission, pass);
    if (group.done == 0)
        run.banks.clear(plan.threads);

    // A line serves both its ends, whatever the direction of the pass.
    LineSweep sweep(run, state, Direction::bidirectional, unit);
    sweep.gather();
    const BundleSettings lattice{mix64(run.settings.seed ^ gather_key), plan.gathering,
                                 run.settings.directions, plan.spacing};
    constexpr std::uint64_t at_once = 16;
    while (group.done < plan.gathering) {
        const std::uint64_t count = std::min(at_once, plan.gathering - group.done);
        load_exits(run, emission, pass, unit, state);
        for (std::uint32_t patch : dark)
            std::fill_n(&state.carried[patch * std::size_t(lanes(state.bands))], state.bands, 0);
        sweep.bundles(lattice, group.done, static_cast<std::uint32_t>(count));
        group.done += count;
        for (WorkerTotals& totals : run.banks.all_totals())
            pass.counts += std::exchange(totals.counts, {});
        if (!run.listener.go_on("bundles",
                                static_cast<double>(plan.passing() + group.done) /
                                    static_cast<double>(plan.bundles),
                                pass.counts.lines))
            break;
    }
    pass.bundles += group.done;
    pass.whole = group.done == plan.gathering;
    state.carried = AlignedArray<std::int32_t>();
    for (WorkerTotals& totals : run.banks.all_totals())
        totals = {};
    take_means(run, unit, pass);
}

}  // namespace parallux
