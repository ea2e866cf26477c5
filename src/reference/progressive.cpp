#include "reference/progressive.h"

#include "reference/sky_points.h"
#include "solve/brightest.h"

namespace parallux {

namespace {

// Ambient = R Σ A_i ΔB_i / Σ A_i with R = 1 / (1 - Σ A_i ρ_i / Σ A_i), Cohen's equations 20 to 22.
std::vector<double> ambient_of(const Run& run, const DirectLight& direct) {
    const Patches& patches = run.patches;
    std::vector<double> ambient(patches.bands, 0), absorbing(patches.bands, 0);
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        absorbing[k % patches.bands] +=
            patches.area[k / patches.bands] * (1 - static_cast<double>(patches.albedo(k)));
    }
    for (std::uint32_t band = 0; band < patches.bands; ++band)
        ambient[band] =
            static_cast<double>(direct.unshot[band]) * run.plan.watts_per_quantum / absorbing[band];
    return ambient;
}

}  // namespace

PassResult progressive_pass(const Run& run, DirectLight& direct) {
    add_sky_points(run, direct);
    shoot_brightest(run, direct, {run.settings.shots, 1e-3, run.plan.shot_rays});
    settle(run, direct);
    PassResult result;
    result.ambient = ambient_of(run, direct);
    result.counts.lines = direct.rays;
    result.whole = !run.listener.stopped();
    return result;
}

}  // namespace parallux
