#include "solve/first_shot.h"

#include <algorithm>
#include <cmath>

#include "random.h"
#include "solve/brightest.h"
#include "solve/emitters.h"
#include "solve/light_points.h"
#include "solve/plan_shots.h"
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

// What the patches emit by themselves.
Emitters own_emitters(const Scene& scene, const Patches& patches, double watts_per_quantum) {
    return emitters_of(scene, patches, [&](std::size_t k) {
        return emitted_quanta(patches, watts_per_quantum, k);
    });
}

// All sources at once.
void shoot_sources(const Run& run, DirectLight& direct) {
    if (run.exact) {
        run.exact->shoot(run, direct.emitted, direct.escaped);
        direct.arrived = true;
        return;
    }
    Emitters emitters = own_emitters(run.scene, run.patches, run.plan.watts_per_quantum);
    if (emitters.pieces.empty())
        return;
    direct.arrived = true;
    direct.done =
        shoot_rays(run, emitters, run.plan.first_shot_rays, run.settings.seed,
                   [&](double done) { return run.listener.go_on("first shot", done, 0); });
    direct.rays = run.plan.first_shot_rays;
    run.banks.take_totals(direct.emitted, direct.escaped);
    if (direct.done < 1)
        stand_for_all(run, direct);
}

}  // namespace

std::unique_ptr<ExactShot> prepare_exact(const Scene& scene, const Patches& patches,
                                         const RayScene* rays, const Plan& plan) {
    if (plan.first_shot != FirstShot::exact || !rays)
        return nullptr;
    const Emitters emitters = own_emitters(scene, patches, plan.watts_per_quantum);
    if (emitters.pieces.empty())
        return nullptr;
    return std::make_unique<ExactShot>(
        scene, patches, *rays, std::make_shared<std::vector<Emitter>>(all_cells(scene, patches)),
        emitters, plan.threads);
}

namespace {

// Relative quadratic error of what has been received along `rays` rays of equal power, times rays:
// m rays leave 1/m of a patch's square, and of an even sequence some fifth of that (0.03 to 0.27 in
// three meshes). What they add to the squares themselves is taken off.
double ray_variance(const Patches& patches, const Banks& banks, double quanta, double rays) {
    constexpr double even = 0.2;
    double error = 0, power = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        double all = 0, square = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band) {
            const double received = static_cast<double>(banks.received(patch, band));
            all += received;
            square += std::pow(patches.reflectance[patch * patches.bands + band] * received, 2);
        }
        if (all <= 0)
            continue;
        const double one = square / patches.area[patch] * (quanta / (rays * all));
        error += one;
        power += square / patches.area[patch] - one;
    }
    return power > 0 ? even * error / power * rays : 0;
}

}  // namespace

void try_rays(const Scene& scene, const Patches& patches, const SolveSettings& settings,
              const RayScene& rays, Banks& banks, Listener& listener, Plan& plan) {
    const Emitters emitters = own_emitters(scene, patches, plan.watts_per_quantum);
    if (emitters.pieces.empty())
        return;
    const std::uint64_t tried = std::max<std::uint64_t>(1 << 14, 8 * patches.count());
    const Run run{scene, patches, settings, plan, &rays, banks, listener};
    shoot_rays(run, emitters, tried, mix64(settings.seed ^ stream::trial_rays),
               [&](double) { return listener.go_on("first shot", 0, 0); });
    set_rays(patches, ray_variance(patches, banks, emitters.total, static_cast<double>(tried)),
             plan);
    for (WorkerTotals& totals : banks.all_totals())
        totals = {};
    banks.clear(plan.threads);
}

DirectLight first_shot(const Run& run) {
    DirectLight direct;
    for (auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped, &direct.unshot})
        totals->assign(run.patches.bands, 0);

    // Shoot from the sources, or leave their power to the pass.
    direct.own = run.plan.first_shot == FirstShot::off;
    if (direct.own) {
        for (std::size_t k = 0; k < run.patches.emission.size(); ++k)
            direct.emitted[k % run.patches.bands] +=
                emitted_quanta(run.patches, run.plan.watts_per_quantum, k);
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
