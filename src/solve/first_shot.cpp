#include "solve/first_shot.h"

#include <algorithm>
#include <cmath>

#include "random.h"
#include "solve/brightest.h"
#include "solve/emitters.h"
#include "solve/light_points.h"
#include "solve/plan_lines.h"
#include "solve/shot_exact.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

// Rays that were stopped early stand for those not cast: a prefix of the sequence is a sample too.
void stand_for_all(const Run& run, DirectLight& direct) {
    run.banks.scale(1 / direct.done);
    for (std::uint32_t band = 0; band < run.patches.bands; ++band) {
        for (auto* totals : {&direct.escaped, &direct.absorbed})
            (*totals)[band] = std::llrint(static_cast<double>((*totals)[band]) / direct.done);
        direct.emitted[band] = direct.escaped[band] + direct.absorbed[band];
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
void shoot_sources(const Run& run, DirectLight& direct, std::uint64_t& done) {
    auto go_on = [&](double share) { return run.listener.go_on("first shot", share, 0); };
    if (run.exact) {
        direct.arrived = true;
        direct.done = run.exact->shoot(run, direct.emitted, direct.escaped, done, go_on);
    } else {
        const Emitters emitters = own_emitters(run.scene, run.patches, run.plan.watts_per_quantum);
        if (emitters.pieces.empty())
            return;
        direct.arrived = true;
        direct.rays = run.plan.first_shot_rays;
        direct.done =
            shoot_rays(run, emitters, run.plan.first_shot_rays, run.settings.seed, done, go_on);
        run.banks.take_totals(direct.emitted, direct.escaped, direct.absorbed);
    }
    if (direct.done < 1)
        stand_for_all(run, direct);
}

}  // namespace

std::unique_ptr<ExactShot> prepare_exact(const Scene& scene, const Patches& patches,
                                         const RayScene* rays, const Plan& plan,
                                         Listener& listener) {
    if (plan.first_shot != FirstShot::exact || !rays)
        return nullptr;
    const Emitters emitters = own_emitters(scene, patches, plan.watts_per_quantum);
    if (emitters.pieces.empty())
        return nullptr;
    return std::make_unique<ExactShot>(
        scene, patches, *rays, std::make_shared<std::vector<Emitter>>(all_cells(scene, patches)),
        emitters, plan.threads, [&] { return listener.go_on("first shot", 0, 0); });
}

namespace {

// What has been received along `rays` rays of equal power tells. m rays leave 1/m of a patch's
// square as its quadratic error, and of an even sequence some fifth of that (0.03 to 0.27 in three
// meshes). What they add to the squares themselves is taken off. Lines leave a patch of area A with
// an error that falls as their number, that is, as A: in all as Σ B² / Σ A B², but for patches that
// local rays are to serve.
Trial trial_of(const Patches& patches, const Banks& banks, double quanta, double rays) {
    constexpr double even = 0.2;
    const double below = too_small(patches);
    double error = 0, power = 0, lit = 0, squares = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        double all = 0, square = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band) {
            const double received = static_cast<double>(banks.received(patch, band));
            all += received;
            square += std::pow(
                scattered(patches, patch * patches.bands + band,
                          [&](std::size_t at) {
                              return static_cast<double>(banks.received(at / patches.bands, band));
                          }),
                2);
        }
        if (all <= 0)
            continue;
        const double area = patches.area[patch];
        const double one = square / area * (quanta / (rays * all));
        error += one;
        power += square / area - one;
        if (area < below)
            continue;
        lit += square / area - one;
        squares += (square / area - one) / area;
    }
    Trial trial;
    trial.known = true;
    trial.variance = power > 0 ? even * error / power * rays : 0;
    trial.lit_area = squares > 0 ? lit / squares : 0;
    return trial;
}

}  // namespace

Trial try_rays(const Run& run, std::uint64_t& done) {
    const Patches& patches = run.patches;
    const Emitters emitters = own_emitters(run.scene, patches, run.plan.watts_per_quantum);
    if (emitters.pieces.empty())
        return {};
    const std::uint64_t tried = std::max<std::uint64_t>(1 << 14, 8 * patches.count());
    shoot_rays(run, emitters, tried, mix64(run.settings.seed ^ stream::trial_rays), done,
               [&](double) { return run.listener.go_on("first shot", 0, 0); });
    const Trial trial = trial_of(patches, run.banks, emitters.total, static_cast<double>(tried));
    for (WorkerTotals& totals : run.banks.all_totals())
        totals = {};
    run.banks.clear(run.plan.threads);
    return trial;
}

void first_shot(const Run& run, Group& group) {
    DirectLight& direct = group.direct;
    const bool own = run.plan.first_shot == FirstShot::off;
    if (group.stage <= Stage::sources) {
        // Shoot from the sources, or leave their power to the pass.
        direct.own = own;
        for (auto* totals : {&direct.emitted, &direct.absorbed, &direct.escaped, &direct.unshot})
            totals->resize(run.patches.bands, 0);
        for (std::size_t k = 0; own && k < run.patches.emission.size(); ++k)
            direct.emitted[k % run.patches.bands] +=
                emitted_quanta(run.patches, run.plan.watts_per_quantum, k);
        if (!own)
            shoot_sources(run, direct, group.done);
        group.enter(Stage::lights);
    }
    if (group.stage == Stage::lights) {
        // Add the lights without area, which have no power of their own to lose: what arrives is
        // what they emitted.
        add_light_points(run, direct, group.done);
        group.enter(Stage::shots);
    }
    // Shoot again from the patches that have most to send.
    if (run.settings.shots > 0 && run.settings.method != Method::progressive)
        shoot_brightest(run, direct, {run.settings.shots, 0, run.plan.shot_rays});
}

}  // namespace parallux
