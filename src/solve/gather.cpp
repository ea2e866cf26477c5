#include "solve/gather.h"

#include <bit>
#include <cmath>
#include <string>

#include "random.h"

namespace parallux {

namespace {

Balance balance_of(const TransferState& state, const DirectLight& direct,
                   const std::vector<std::int64_t>& planned) {
    Balance balance;
    balance.watts_per_quantum = state.watts_per_quantum;
    std::uint32_t bands = state.bands;
    std::vector<std::int64_t> received(bands, 0), reflected(bands, 0), unshot(bands, 0);
    for (std::size_t k = 0; k < direct.received.size(); ++k) {
        received[k % bands] += direct.received[k];
        reflected[k % bands] += direct.reflected[k];
        unshot[k % bands] += state.unshot[k];
    }
    for (std::uint32_t band = 0; band < bands; ++band) {
        // Emission of the patches themselves, where no first shot took it over.
        std::int64_t own = planned[band] - reflected[band];
        balance.emitted.push_back(direct.emitted[band] + own + state.sky[band]);
        balance.absorbed.push_back(received[band] - reflected[band] + state.absorbed[band]);
        balance.escaped.push_back(direct.escaped[band] + state.escaped[band]);
        // Emission that the realised lines did not carry waits like all unshot energy.
        balance.unshot.push_back(unshot[band] + planned[band] - state.emitted[band]);
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

Solution gather(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                const Plan& plan, const DirectLight& direct,
                const std::vector<std::int64_t>& planned, const PassResult& pass,
                TransferState& state) {
    Solution solution;
    std::uint32_t bands = patches.bands;
    solution.bands = bands;
    solution.radiosity.resize(patches.count() * bands);
    solution.irradiance.resize(patches.count() * bands);
    std::vector<double> factors = pass.leftover.factors(state, patches, planned, pass.done);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::size_t k = patch * bands + band;
            double quanta = static_cast<double>(direct.received[k]) +
                            factors[pass.leftover.group(patch) * bands + band] *
                                static_cast<double>(state.received[k]);
            double irradiance = quanta * state.watts_per_quantum / patches.area[patch];
            solution.irradiance[k] = static_cast<float>(irradiance);
            solution.radiosity[k] = static_cast<float>(
                patches.emission[k] + static_cast<double>(patches.reflectance[k]) * irradiance);
        }
    solution.hash = hash_of(solution);
    solution.energy = balance_of(state, direct, planned);
    solution.counts = pass.counts;
    solution.leaks = is_closed(scene) ? pass.counts.odd : 0;
    if (solution.leaks > 0)
        solution.warnings.push_back(std::to_string(solution.leaks) +
                                    " lines met a closed scene an odd number of times");
    solution.crossings = std::move(state.exits);
    solution.bundles = pass.bundles;
    solution.line_spacing = plan.spacing;
    solution.batch = plan.batch;
    solution.threads = plan.threads;
    solution.first_shot_rays = plan.first_shot_rays;
    solution.partial = !pass.whole || direct.done < 1;
    if (settings.method == Method::lines)
        solution.line_spacing = std::sqrt(plan.cell);
    return solution;
}

}  // namespace parallux
