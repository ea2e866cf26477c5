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

// Rays that were stopped early stand for those not cast: a prefix of the sequence is a sample too.
void stand_for_all(const Run& run, DirectLight& direct) {
    run.banks.scale(1 / direct.done);
    for (std::uint32_t band = 0; band < run.patches.bands; ++band) {
        direct.escaped[band] = std::llrint(static_cast<double>(direct.escaped[band]) / direct.done);
        direct.emitted[band] = direct.escaped[band];
        for (std::size_t patch = 0; patch < run.patches.count(); ++patch)
            direct.emitted[band] += run.banks.received(patch, band);
    }
}

// All sources at once.
void shoot_sources(const Run& run, DirectLight& direct) {
    Emitters emitters =
        emitters_of(run.scene, run.patches, [&](std::size_t k) { return emitted_quanta(run, k); });
    if (emitters.pieces.empty())
        return;
    direct.arrived = true;
    if (run.plan.first_shot == FirstShot::exact) {
        shoot_exact(run, emitters, direct.emitted, direct.escaped);
        return;
    }
    direct.done =
        shoot_rays(run, emitters, run.plan.first_shot_rays, run.settings.seed,
                   [&](double done) { return run.listener.go_on("first shot", done, 0); });
    direct.rays = run.plan.first_shot_rays;
    run.banks.take_totals(direct.emitted, direct.escaped);
    if (direct.done < 1)
        stand_for_all(run, direct);
}

}  // namespace

DirectLight first_shot(const Run& run) {
    DirectLight direct;
    for (auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped, &direct.unshot})
        totals->assign(run.patches.bands, 0);

    // Shoot from the sources, or leave their power to the pass.
    direct.own = run.plan.first_shot == FirstShot::off;
    if (direct.own) {
        for (std::size_t k = 0; k < run.patches.emission.size(); ++k)
            direct.emitted[k % run.patches.bands] += emitted_quanta(run, k);
    } else {
        shoot_sources(run, direct);
    }

    // Add the lights without area, which have no power of their own to lose: what arrives is what
    // they emitted.
    add_light_points(run, direct);

    // Shoot again from the patches that have most to send.
    if (run.settings.shots > 0 && run.settings.method != Method::progressive)
        shoot_brightest(run, direct, {run.settings.shots, 0, run.plan.shot_rays});
    return direct;
}

}  // namespace parallux
