#include "solve/direct_light.h"

#include <array>
#include <cmath>
#include <utility>

#include "parallel.h"

namespace parallux {

namespace {

// What has arrived, k = patch * bands + band.
std::int64_t received_of(const Run& run, std::size_t k) {
    const std::uint32_t bands = run.patches.bands;
    return run.banks.received(k / bands, static_cast<std::uint32_t>(k % bands));
}

// Band totals of one worker's patches.
struct alignas(64) Totals {
    std::array<std::int64_t, max_bands> absorbed{}, unshot{};
};

}  // namespace

std::int64_t emitted_quanta(const Patches& patches, double watts_per_quantum, std::size_t k) {
    return std::llrint(patches.area[k / patches.bands] * patches.emission[k] / watts_per_quantum);
}

std::int64_t unshot_quanta(const Run& run, const DirectLight& direct, std::size_t k) {
    std::int64_t unshot =
        scattered_quanta(run.patches, k, [&](std::size_t at) { return received_of(run, at); });
    if (direct.own)
        unshot += emitted_quanta(run.patches, run.plan.watts_per_quantum, k);
    return unshot - direct.sent_on(k);
}

void settle(const Run& run, DirectLight& direct) {
    if (std::exchange(direct.settled, true))
        return;
    const Patches& patches = run.patches;
    const std::uint32_t bands = patches.bands;
    if (direct.arrived)
        direct.irradiance.resize(patches.reflectance.size());
    if (!direct.shot.empty())
        direct.exitance.resize(patches.reflectance.size());
    std::vector<Totals> totals(run.plan.threads);
    auto settle_patch = [&](std::size_t patch, Totals& sums) {
        const double unit = run.plan.watts_per_quantum / patches.area[patch];
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::size_t k = patch * bands + band;
            const std::int64_t received = run.banks.received(patch, band);
            const std::int64_t unshot = unshot_quanta(run, direct, k);
            sums.absorbed[band] += received - passed_on(patches, k, received);
            sums.unshot[band] += unshot;
            if (direct.arrived)
                direct.irradiance[k] = static_cast<float>(unit * static_cast<double>(received));
            if (!direct.shot.empty())
                direct.exitance[k] = static_cast<float>(unit * static_cast<double>(unshot));
        }
        // The other side still asks what has arrived here.
        if (direct.arrived && !patches.translucent())
            run.banks.clear_patch(patch);
    };
    parallel_for(run.plan.threads, patches.count(), 4096,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     for (std::size_t patch = begin; patch < end; ++patch)
                         settle_patch(patch, totals[worker]);
                 });
    if (direct.arrived && patches.translucent())
        run.banks.clear(run.plan.threads);
    for (const Totals& sums : totals)
        for (std::uint32_t band = 0; band < bands; ++band) {
            direct.absorbed[band] += sums.absorbed[band];
            direct.unshot[band] += sums.unshot[band];
        }
    direct.shot = std::vector<std::int64_t>();
}

Emission emission_of(const Patches& patches, const DirectLight& direct) {
    Emission emission;
    if (!direct.exitance.empty()) {
        emission.own = direct.exitance;
        return emission;
    }
    if (direct.own)
        emission.own = patches.emission;
    emission.direct = direct.irradiance;
    return emission;
}

}  // namespace parallux
