#include "solve/end_pass.h"

#include <cmath>

#include "parallel.h"
#include "solve/run.h"

namespace parallux {

namespace {

// Reflected and transmitted power that was not sent on, band totals.
std::vector<std::int64_t> unshot_of(const Run& run, const TransferState& state) {
    const Patches& patches = run.patches;
    std::vector<std::int64_t> unshot(state.bands, 0);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t band = 0; band < state.bands; ++band) {
            std::size_t k = patch * state.bands + band;
            const std::int64_t all = scattered_quanta(patches, k, [&](std::size_t at) {
                return run.banks.received(at / state.bands, band);
            });
            // Modulo 2^64, as below.
            unshot[band] = static_cast<std::int64_t>(static_cast<std::uint64_t>(unshot[band]) +
                                                     static_cast<std::uint64_t>(all) -
                                                     static_cast<std::uint64_t>(state.sent[k]));
        }
    return unshot;
}

// In the quanta of the plan, of which one of the state is a whole number.
Balance balance_of(const Run& run, const DirectLight& direct, const TransferState& state) {
    Balance balance;
    balance.watts_per_quantum = run.plan.watts_per_quantum;
    const std::vector<std::int64_t> unshot = unshot_of(run, state);
    const auto unit =
        static_cast<std::int64_t>(state.watts_per_quantum / run.plan.watts_per_quantum);
    // Modulo 2^64, which no run comes near: a checkpoint may be made up.
    auto all = [&](std::int64_t shot, std::int64_t passed) {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(shot) +
                                         static_cast<std::uint64_t>(unit) *
                                             static_cast<std::uint64_t>(passed));
    };
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        balance.emitted.push_back(all(direct.emitted[band], state.sky[band]));
        balance.absorbed.push_back(all(direct.absorbed[band], state.absorbed[band]));
        balance.escaped.push_back(all(direct.escaped[band], state.escaped[band]));
        // Power that the pass was to send but did not waits like all unshot energy.
        const auto waiting = static_cast<std::uint64_t>(unshot[band]) -
                             static_cast<std::uint64_t>(state.emitted[band]);
        balance.unshot.push_back(all(direct.unshot[band], static_cast<std::int64_t>(waiting)));
        balance.residual.push_back(
            static_cast<std::int64_t>(static_cast<std::uint64_t>(balance.emitted[band]) -
                                      static_cast<std::uint64_t>(balance.absorbed[band]) -
                                      static_cast<std::uint64_t>(balance.escaped[band]) -
                                      static_cast<std::uint64_t>(balance.unshot[band])));
    }
    return balance;
}

}  // namespace

void end_pass(const Run& run, const DirectLight& direct, TransferState& state, PassResult& pass) {
    const Patches& patches = run.patches;
    const std::uint32_t bands = patches.bands;
    pass.balance = balance_of(run, direct, state);
    Leftover::Spread spread;
    if (pass.leftover)
        spread = pass.leftover->spread(state, run.banks, pass.done);
    else
        spread.factor.assign(bands, pass.received);
    state.sent = std::vector<std::int64_t>();
    state.carried = AlignedArray<std::int32_t>();
    pass.irradiance.resize(patches.reflectance.size());
    pass.crossings.resize(patches.count());
    auto finish = [&](std::size_t patch) {
        const std::uint32_t region = pass.leftover ? pass.leftover->region(patch) : 0;
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::int64_t quanta = run.banks.received(patch, band);
            double received = static_cast<double>(quanta);
            if (pass.leftover && pass.leftover->reached(patch, quanta, spread.fine[band]))
                received +=
                    spread.to_come[region * std::size_t(bands) + band] * patches.area[patch];
            const double ambient = pass.ambient.empty() ? 0 : pass.ambient[band];
            pass.irradiance[patch * bands + band] = static_cast<float>(
                spread.factor[band] * received * state.watts_per_quantum / patches.area[patch] +
                ambient);
        }
        pass.crossings[patch] = static_cast<std::uint64_t>(run.banks.exits(patch));
    };
    parallel_for(run.plan.threads, patches.count(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t patch = begin; patch < end; ++patch)
                         finish(patch);
                 });
    pass.leftover.reset();
}

}  // namespace parallux
