#include "solve/brightest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "random.h"
#include "solve/emitters.h"
#include "solve/shot_exact.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

constexpr double least_rays = 64;

// Unshot power of a patch over all bands.
double unshot_of(const DirectLight& direct, std::size_t patch, std::uint32_t bands) {
    double sum = 0;
    for (std::uint32_t band = 0; band < bands; ++band)
        sum += static_cast<double>(direct.unshot[patch * bands + band]);
    return sum;
}

double sum_of(const std::vector<std::int64_t>& quanta) {
    return std::accumulate(quanta.begin(), quanta.end(), 0.0,
                           [](double sum, std::int64_t q) { return sum + static_cast<double>(q); });
}

// Takes over what one shot brought: received, absorbed in part, the rest unshot.
void take_over(const Run& run, DirectLight& shot, DirectLight& direct) {
    for (std::size_t k = 0; k < shot.received.size(); ++k) {
        if (shot.received[k] == 0)
            continue;
        std::int64_t received = std::exchange(shot.received[k], 0);
        std::int64_t reflected = std::llrint(static_cast<double>(run.patches.reflectance[k]) *
                                             static_cast<double>(received));
        direct.received[k] += received;
        direct.unshot[k] += reflected;
        direct.absorbed[k % run.patches.bands] += received - reflected;
    }
    for (std::size_t band = 0; band < shot.escaped.size(); ++band)
        direct.escaped[band] += std::exchange(shot.escaped[band], 0);
}

}  // namespace

void shoot_brightest(const Run& run, DirectLight& direct, const BrightestSettings& settings) {
    const std::uint32_t bands = run.patches.bands;
    const PatchCells cells(run.scene, run.patches);
    DirectLight shot;
    shot.received.assign(direct.received.size(), 0);
    shot.emitted.assign(bands, 0);
    shot.escaped.assign(bands, 0);
    const double emitted = sum_of(direct.emitted), enough = settings.until * emitted;
    double left = sum_of(direct.unshot);
    auto go_on = [&] {
        double done = settings.shots
                          ? static_cast<double>(direct.shots) / static_cast<double>(settings.shots)
                          : enough / std::max(left, enough);
        return run.listener.go_on("shots", done, direct.rays);
    };

    while (left > enough && (settings.shots == 0 || direct.shots < settings.shots) && go_on()) {
        // Choose the patch with most unshot power, and take the power from it.
        std::size_t patch = 0;
        double most = 0;
        for (std::size_t k = 0; k < run.patches.count(); ++k)
            if (double unshot = unshot_of(direct, k, bands); unshot > most) {
                most = unshot;
                patch = k;
            }
        if (most <= 0)
            break;
        std::span<std::int64_t> power(&direct.unshot[patch * bands], bands);
        Emitters emitters = cells.emitters(static_cast<std::uint32_t>(patch), power);

        // Shoot it: what left the patch is what the shot says it emitted.
        if (run.plan.first_shot == FirstShot::exact) {
            shoot_exact(run, emitters, shot);
        } else {
            auto rays = static_cast<std::uint64_t>(
                std::clamp(most / emitted * settings.rays, least_rays, 4e9));
            shoot_rays(run, emitters, rays,
                       mix64(run.settings.seed + 0x9e3779b97f4a7c15ull * (direct.shots + 1)),
                       [&](double) { return !run.listener.stopped(); });
            run.banks.collect(shot.received, shot.emitted, shot.escaped);
            direct.rays += rays;
        }
        for (std::uint32_t band = 0; band < bands; ++band)
            power[band] -= std::exchange(shot.emitted[band], 0);
        take_over(run, shot, direct);
        ++direct.shots;
        left = sum_of(direct.unshot);
    }
}

}  // namespace parallux
