#include "solve/pass.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"
#include "solve/power.h"

namespace parallux {

double emission_quanta(const Plan& plan, const TransferState& state) {
    return plan.emission_cell / state.watts_per_quantum;
}

double carried_quantum(const Run& run, const Emission& emission) {
    // The brightest of all that emits, W/m².
    const Patches& patches = run.patches;
    Emission exitance = emission;
    exitance.quanta = 1;
    std::vector<double> worker_most(run.plan.threads, 0);
    parallel_for(run.plan.threads, patches.reflectance.size(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     double most = worker_most[worker];
                     for (std::size_t k = begin; k < end; ++k)
                         most = std::max(most, exitance.of_exit(patches, k));
                     worker_most[worker] = most;
                 });
    double most = *std::max_element(worker_most.begin(), worker_most.end());
    for (std::uint32_t band = 0; band < patches.bands; ++band)
        most = std::max(most, pi * sky_bound(run.scene.sky, band));

    // Of what may be carried a quarter is left for energy that has waited.
    constexpr double whitest = 1 - 1.0 / 64, usual = most_carried / 4;
    const double brightest = most / (1 - std::min(run.plan.highest_reflectance, whitest));
    double quantum = run.plan.watts_per_quantum;
    while (brightest * run.plan.emission_cell / quantum > usual)
        quantum *= 2;
    return quantum;
}

SkyQuanta sky_quanta(const Scene& scene, double unit, const glm::dvec3& direction) {
    SkyQuanta quanta;
    Spectrum behind = scene.sky.radiance(-direction), ahead = scene.sky.radiance(direction);
    for (std::uint32_t band = 0; band < scene.bands; ++band) {
        quanta.along[band] = std::llrint(unit * pi * behind[band]);
        quanta.against[band] = std::llrint(unit * pi * ahead[band]);
    }
    return quanta;
}

}  // namespace parallux
