#include "solve/gather.h"

#include <bit>
#include <cmath>
#include <string>

#include "parallel.h"
#include "random.h"
#include "solve/run.h"

namespace parallux {

namespace {

// Reflected power that was not sent on, band totals.
std::vector<std::int64_t> unshot_of(const Run& run, const TransferState& state) {
    const Patches& patches = run.patches;
    std::vector<std::int64_t> unshot(state.bands, 0);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t band = 0; band < state.bands; ++band) {
            std::size_t k = patch * state.bands + band;
            unshot[band] += std::llrint(static_cast<double>(patches.reflectance[k]) *
                                        static_cast<double>(run.banks.received(patch, band))) -
                            state.sent[k];
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
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        balance.emitted.push_back(direct.emitted[band] + unit * state.sky[band]);
        balance.absorbed.push_back(direct.absorbed[band] + unit * state.absorbed[band]);
        balance.escaped.push_back(direct.escaped[band] + unit * state.escaped[band]);
        // Power that the pass was to send but did not waits like all unshot energy.
        balance.unshot.push_back(direct.unshot[band] + unit * (unshot[band] - state.emitted[band]));
        balance.residual.push_back(balance.emitted[band] - balance.absorbed[band] -
                                   balance.escaped[band] - balance.unshot[band]);
    }
    return balance;
}

std::uint64_t hash_of(const Solution& solution) {
    std::uint64_t hash = mix64(solution.bands);
    for (const auto* values : {&solution.radiosity, &solution.irradiance})
        for (float value : *values)
            hash = mix64(hash ^ std::bit_cast<std::uint32_t>(value)) + 0x9e3779b97f4a7c15ull;
    return hash;
}

}  // namespace

Solution gather(const Run& run, DirectLight& direct, const PassResult& pass, TransferState& state) {
    const Patches& patches = run.patches;
    const Plan& plan = run.plan;
    const std::uint32_t bands = patches.bands;
    Solution solution;
    solution.bands = bands;
    solution.energy = balance_of(run, direct, state);
    std::vector<double> factors(bands, pass.received);
    if (pass.leftover)
        factors = pass.leftover->factors(state, run.banks, pass.done);

    // The state has done its work: its memory is the result's.
    run.banks.join(plan.threads);
    state.sent = std::vector<std::int64_t>();
    state.carried = AlignedArray<std::int32_t>();
    solution.irradiance = std::move(direct.irradiance);
    solution.irradiance.resize(patches.reflectance.size(), 0);
    solution.radiosity.resize(patches.reflectance.size());
    solution.crossings.resize(patches.count());
    auto finish = [&](std::size_t first, std::size_t last, const double* factor) {
        for (std::size_t patch = first; patch < last; ++patch) {
            const double unit = state.watts_per_quantum / patches.area[patch];
            for (std::uint32_t band = 0; band < bands; ++band) {
                const std::size_t k = patch * bands + band;
                double irradiance =
                    solution.irradiance[k] +
                    factor[band] * static_cast<double>(run.banks.received(patch, band)) * unit;
                if (!pass.ambient.empty())
                    irradiance += pass.ambient[band];
                solution.irradiance[k] = static_cast<float>(irradiance);
                solution.radiosity[k] = static_cast<float>(
                    patches.emission[k] + static_cast<double>(patches.reflectance[k]) * irradiance);
            }
            solution.crossings[patch] = static_cast<std::uint64_t>(run.banks.exits(patch));
        }
    };
    parallel_for(plan.threads, patches.count(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     if (!pass.leftover)
                         return finish(begin, end, factors.data());
                     pass.leftover->for_groups(
                         begin, end, [&](std::size_t first, std::size_t last, std::uint32_t group) {
                             finish(first, last, &factors[group * bands]);
                         });
                 });
    solution.hash = hash_of(solution);
    solution.counts = pass.counts;
    solution.leaks = is_closed(run.scene) ? pass.counts.odd : 0;
    solution.warnings = pass.warnings;
    if (solution.leaks > 0)
        solution.warnings.push_back(std::to_string(solution.leaks) +
                                    " lines met a closed scene an odd number of times");
    solution.bundles = pass.bundles;
    solution.line_spacing = plan.spacing;
    solution.batch = plan.batch;
    solution.threads = plan.threads;
    solution.first_shot_rays = plan.first_shot_rays;
    solution.shots = direct.shots;
    solution.partial = !pass.whole || direct.done < 1;
    return solution;
}

}  // namespace parallux
