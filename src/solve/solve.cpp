#include "parallux/solve.h"

#include <chrono>
#include <cmath>
#include <memory>

#include "solve/first_shot.h"
#include "solve/gather.h"
#include "solve/global_pass.h"
#include "solve/plan.h"

// A parallel form of M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity (LSI-93-37-R,
// 1993), over bundles of parallel lines.

namespace parallux {

namespace {

class Watch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// What each exit carries of a patch's own light over the whole run: of the reflected direct light
// after a first shot, else of the emission itself. Returns what all exits are expected to carry.
std::vector<std::int64_t> set_emission(const Patches& patches, const DirectLight& direct,
                                       const SolveSettings& settings, const Plan& plan,
                                       TransferState& state) {
    std::vector<std::int64_t> planned(patches.bands, 0);
    bool shot = settings.first_shot != FirstShot::off;
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        for (std::uint32_t band = 0; band < patches.bands; ++band) {
            std::size_t k = patch * patches.bands + band;
            double area = patches.area[patch];
            double power = static_cast<double>(direct.reflected[k]);
            if (!shot)
                power += area * patches.emission[k] / plan.watts_per_quantum;
            state.emission[k] = std::llrint(power / area * plan.emission_cell);
            planned[band] += std::llrint(power);
        }
    return planned;
}

DirectLight no_direct_light(const Patches& patches) {
    DirectLight direct;
    direct.received.assign(patches.count() * patches.bands, 0);
    direct.reflected = direct.received;
    direct.emitted.assign(patches.bands, 0);
    direct.escaped = direct.emitted;
    return direct;
}

// Asks the caller whether to go on, and minds the time limit.
class Listener {
public:
    Listener(const ProgressCallback& callback, double time_limit)
        : callback_(callback), time_limit_(time_limit) {}

    bool go_on(const char* stage, double done, std::uint64_t lines, double stage_seconds) {
        if (callback_ && !callback_({stage, done, lines, stage_seconds}))
            stopped_ = true;
        if (time_limit_ > 0 && total_.seconds() > time_limit_)
            stopped_ = true;
        return !stopped_;
    }

private:
    const ProgressCallback& callback_;
    double time_limit_;
    Watch total_;
    bool stopped_ = false;
};

}  // namespace

Solution solve(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const ProgressCallback& progress) {
    // Settle every number of the run.
    Plan plan = make_plan(scene, patches, settings);
    Listener listener(progress, settings.time_limit);
    DeltaBanks banks(patches.count(), patches.bands, plan.threads, plan.bank_bytes);
    Seconds seconds;

    // Shoot the light of the sources locally.
    Watch first_watch;
    std::unique_ptr<RayScene> rays;
    if (plan.first_shot || settings.method == Method::lines)
        rays = std::make_unique<RayScene>(scene, plan.threads);
    DirectLight direct = no_direct_light(patches);
    if (plan.first_shot)
        direct =
            first_shot(scene, patches, *rays,
                       {plan.first_shot_rays, settings.seed, plan.threads, plan.watts_per_quantum},
                       banks, [&](double done) {
                           return listener.go_on("first shot", done, 0, first_watch.seconds());
                       });
    seconds.first_shot = first_watch.seconds();

    // Send the reflected light along global lines, batch after batch.
    Watch global_watch;
    TransferState state = dark_state(patches, plan.watts_per_quantum);
    std::vector<std::int64_t> planned = set_emission(patches, direct, settings, plan, state);
    const char* stage = settings.method == Method::bundles ? "bundles" : "lines";
    PassResult pass =
        global_pass(scene, patches, rays.get(), settings, plan, state, banks,
                    [&](std::uint64_t bundles, std::uint64_t lines) {
                        return listener.go_on(
                            stage, static_cast<double>(bundles) / static_cast<double>(plan.bundles),
                            lines, global_watch.seconds());
                    });
    seconds.global = global_watch.seconds();

    // Spread what is left, and turn quanta into watts.
    Watch gather_watch;
    Solution solution = gather(scene, patches, settings, plan, direct, planned, pass, state);
    solution.seconds = seconds;
    solution.seconds.gather = gather_watch.seconds();
    return solution;
}

}  // namespace parallux
