#include "solve/first_shot.h"

#include <algorithm>
#include <cmath>

#include "solve/brightest.h"
#include "solve/emitters.h"
#include "solve/light_points.h"
#include "solve/shot_exact.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

std::vector<std::int64_t> emitted_power(const Run& run) {
    const Patches& patches = run.patches;
    std::vector<std::int64_t> power(patches.count() * patches.bands);
    for (std::size_t k = 0; k < power.size(); ++k)
        power[k] = std::llrint(patches.area[k / patches.bands] * patches.emission[k] /
                               run.plan.watts_per_quantum);
    return power;
}

// Rays that were stopped early stand for those not cast: a prefix of the sequence is a sample too.
void stand_for_all(DirectLight& direct, std::uint32_t bands) {
    auto scale = [&](std::int64_t& quanta) {
        quanta = std::llrint(static_cast<double>(quanta) / direct.done);
    };
    for (std::uint32_t band = 0; band < bands; ++band) {
        scale(direct.escaped[band]);
        direct.emitted[band] = direct.escaped[band];
    }
    for (std::size_t k = 0; k < direct.received.size(); ++k) {
        scale(direct.received[k]);
        direct.emitted[k % bands] += direct.received[k];
    }
}

// All sources at once.
void shoot_sources(const Run& run, const std::vector<std::int64_t>& power, DirectLight& direct) {
    Emitters emitters = emitters_of(run.scene, run.patches, power);
    if (emitters.pieces.empty())
        return;
    if (run.plan.first_shot == FirstShot::exact) {
        shoot_exact(run, emitters, direct);
        return;
    }
    direct.done =
        shoot_rays(run, emitters, run.plan.first_shot_rays, run.settings.seed,
                   [&](double done) { return run.listener.go_on("first shot", done, 0); });
    direct.rays = run.plan.first_shot_rays;
    run.banks.collect(direct.received, direct.emitted, direct.escaped);
    if (direct.done < 1)
        stand_for_all(direct, run.patches.bands);
}

}  // namespace

DirectLight first_shot(const Run& run) {
    std::uint32_t bands = run.patches.bands;
    DirectLight direct;
    direct.received.assign(run.patches.count() * bands, 0);
    for (auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped})
        totals->assign(bands, 0);

    // Shoot from the sources, or leave their power to the pass.
    std::vector<std::int64_t> power = emitted_power(run);
    bool shot = run.plan.first_shot != FirstShot::off;
    if (shot)
        shoot_sources(run, power, direct);

    // Add the lights without area, which have no power of their own to lose: what arrives is what
    // they emitted.
    add_light_points(run, direct);

    // What arrived is absorbed in part, and the rest is unshot.
    direct.unshot = std::move(power);
    for (std::size_t k = 0; k < direct.received.size(); ++k) {
        std::int64_t own = shot ? 0 : direct.unshot[k];
        std::int64_t reflected = std::llrint(static_cast<double>(run.patches.reflectance[k]) *
                                             static_cast<double>(direct.received[k]));
        direct.unshot[k] = own + reflected;
        direct.emitted[k % bands] += own;
        direct.absorbed[k % bands] += direct.received[k] - reflected;
    }

    // Shoot again from the patches that have most to send.
    if (run.settings.shots > 0 && run.settings.method != Method::progressive)
        shoot_brightest(run, direct, {run.settings.shots, 0, run.plan.shot_rays});
    return direct;
}

}  // namespace parallux
