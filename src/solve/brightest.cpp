#include "solve/brightest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "random.h"
#include "solve/emitters.h"
#include "solve/shot_exact.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

constexpr double least_rays = 64;

double sum_of(const std::vector<std::int64_t>& quanta) {
    return std::accumulate(quanta.begin(), quanta.end(), 0.0,
                           [](double sum, std::int64_t q) { return sum + static_cast<double>(q); });
}

// The patch with most unshot power over all bands, that power, and what all have together.
struct Brightest {
    std::uint32_t patch = 0;
    std::int64_t most = 0, all = 0;
};

Brightest brightest_of(const Run& run, const DirectLight& direct) {
    Brightest found;
    for (std::uint32_t patch = 0; patch < run.patches.count(); ++patch) {
        std::int64_t unshot = 0;
        for (std::uint32_t band = 0; band < run.patches.bands; ++band)
            unshot += unshot_quanta(run, direct, patch * std::size_t(run.patches.bands) + band);
        found.all += unshot;
        if (unshot > found.most) {
            found.most = unshot;
            found.patch = patch;
        }
    }
    return found;
}

}  // namespace

void shoot_brightest(const Run& run, DirectLight& direct, const BrightestSettings& settings) {
    const std::uint32_t bands = run.patches.bands;
    const PatchCells cells(run.scene, run.patches);
    const bool exact = run.plan.first_shot == FirstShot::exact;
    ExactShot::Cells receivers;
    if (exact)
        receivers = std::make_shared<std::vector<Emitter>>(all_cells(run.scene, run.patches));
    direct.arrived = true;
    direct.shot.resize(run.patches.reflectance.size(), 0);
    const double emitted = sum_of(direct.emitted), enough = settings.until * emitted;
    auto go_on = [&](double left) {
        double done = settings.shots
                          ? static_cast<double>(direct.shots) / static_cast<double>(settings.shots)
                          : enough / std::max(left, enough);
        return run.listener.go_on("shots", done, direct.rays);
    };

    while (settings.shots == 0 || direct.shots < settings.shots) {
        // Choose the patch with most unshot power.
        const Brightest brightest = brightest_of(run, direct);
        const double left = static_cast<double>(brightest.all);
        if (!(left > enough) || !go_on(left) || brightest.most <= 0)
            break;
        const std::size_t first = brightest.patch * std::size_t(bands);
        std::vector<std::int64_t> power;
        for (std::uint32_t band = 0; band < bands; ++band)
            power.push_back(unshot_quanta(run, direct, first + band));
        Emitters emitters = cells.emitters(brightest.patch, power);

        // Shoot it: what left the patch is what the shot says it emitted.
        std::vector<std::int64_t> shot(bands, 0);
        std::uint64_t done = 0;
        if (exact) {
            ExactShot(run.scene, run.patches, *run.rays, receivers, emitters, run.plan.threads, [] {
                return true;
            }).shoot(run, shot, direct.escaped, done, [](double) { return true; });
        } else {
            auto rays = static_cast<std::uint64_t>(std::clamp(
                static_cast<double>(brightest.most) / emitted * settings.rays, least_rays, 4e9));
            shoot_rays(run, emitters, rays,
                       mix64(run.settings.seed + 0x9e3779b97f4a7c15ull * (direct.shots + 1)), done,
                       [&](double) { return !run.listener.stopped(); });
            run.banks.take_totals(shot, direct.escaped, direct.absorbed);
            direct.rays += rays;
        }
        for (std::uint32_t band = 0; band < bands; ++band)
            direct.shot[first + band] += shot[band];
        ++direct.shots;
    }
}

}  // namespace parallux
