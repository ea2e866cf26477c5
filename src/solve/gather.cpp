#include "solve/gather.h"

#include <bit>
#include <cmath>
#include <string>

#include "random.h"
#include "solve/run.h"

namespace parallux {

namespace {

Balance balance_of(const TransferState& state, const DirectLight& direct) {
    Balance balance;
    balance.watts_per_quantum = state.watts_per_quantum;
    std::uint32_t bands = state.bands;
    std::vector<std::int64_t> unshot(bands, 0);
    // Power that the pass was to send but did not waits like all unshot energy.
    for (std::size_t k = 0; k < direct.unshot.size(); ++k)
        unshot[k % bands] += direct.unshot[k] + state.unshot[k];
    for (std::uint32_t band = 0; band < bands; ++band) {
        balance.emitted.push_back(direct.emitted[band] + state.sky[band]);
        balance.absorbed.push_back(direct.absorbed[band] + state.absorbed[band]);
        balance.escaped.push_back(direct.escaped[band] + state.escaped[band]);
        balance.unshot.push_back(unshot[band] - state.emitted[band]);
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

Solution gather(const Run& run, const DirectLight& direct, const PassResult& pass,
                TransferState& state) {
    const Patches& patches = run.patches;
    const Plan& plan = run.plan;
    Solution solution;
    std::uint32_t bands = patches.bands;
    solution.bands = bands;
    solution.radiosity.resize(patches.count() * bands);
    solution.irradiance.resize(patches.count() * bands);
    std::vector<double> factors;
    if (pass.leftover)
        factors = pass.leftover->factors(state, patches, pass.done);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::size_t k = patch * bands + band;
            double factor = pass.leftover ? factors[pass.leftover->group(patch) * bands + band] : 1;
            double quanta = static_cast<double>(direct.received[k]) +
                            factor * static_cast<double>(state.received[k]);
            double irradiance = quanta * state.watts_per_quantum / patches.area[patch];
            if (!pass.ambient.empty())
                irradiance += pass.ambient[band];
            solution.irradiance[k] = static_cast<float>(irradiance);
            solution.radiosity[k] = static_cast<float>(
                patches.emission[k] + static_cast<double>(patches.reflectance[k]) * irradiance);
        }
    solution.hash = hash_of(solution);
    solution.energy = balance_of(state, direct);
    solution.counts = pass.counts;
    solution.leaks = is_closed(run.scene) ? pass.counts.odd : 0;
    solution.warnings = pass.warnings;
    if (solution.leaks > 0)
        solution.warnings.push_back(std::to_string(solution.leaks) +
                                    " lines met a closed scene an odd number of times");
    solution.crossings = std::move(state.exits);
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
