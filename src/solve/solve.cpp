#include "parallux/solve.h"

#include <memory>

#include "parallel.h"
#include "reference/matrix.h"
#include "reference/particles.h"
#include "reference/progressive.h"
#include "solve/closing_gather.h"
#include "solve/end_pass.h"
#include "solve/estimate.h"
#include "solve/first_shot.h"
#include "solve/global_pass.h"
#include "solve/in_order_pass.h"
#include "solve/run.h"

// M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity (LSI-93-37-R, 1993): as printed,
// in parallel form over bundles of parallel lines, and beside the methods it is judged against.

namespace parallux {

namespace {

// Carries the unshot power between the patches, in the way that was chosen.
PassResult carry(const Run& run, DirectLight& direct, TransferState& state) {
    switch (run.settings.method) {
        case Method::lines:
            if (run.plan.batch == 0)
                return in_order_pass(run, direct, state);
            break;
        case Method::progressive:
            return progressive_pass(run, direct);
        case Method::particles:
            return particle_pass(run, direct, state);
        case Method::matrix:
            return matrix_pass(run, direct, state);
        case Method::bundles:
            break;
    }
    return global_pass(run, direct, state);
}

}  // namespace

Solution solve(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const ProgressCallback& progress) {
    // Settle every number of the run.
    Plan plan = make_plan(scene, patches, settings);
    Listener listener(progress, settings.time_limit);
    Banks banks(patches.count(), patches.bands, plan.threads, plan.bank_bytes);
    Seconds seconds;

    std::unique_ptr<RayScene> rays;
    if (needs_rays(scene, patches, settings))
        rays = std::make_unique<RayScene>(scene, plan.threads);
    Team team(plan.threads);
    DirectLight direct;
    Estimate estimate(patches);
    for (std::uint32_t group = 0; group < plan.groups; ++group) {
        SolveSettings own = settings;
        own.seed = group_seed(settings.seed, group);
        const Run run{scene, patches, own, plan, rays.get(), banks, listener};
        listener.begin_part(group, plan.groups);

        // Shoot the light of the sources locally.
        Watch watch;
        if (group == 0 || plan.shoot_each)
            direct = first_shot(run);
        seconds.first_shot += watch.lap();

        // Send what is left unshot along global lines, or by a reference method.
        const double loops_before = seconds_in_loops();
        TransferState state = dark_state(patches, plan.watts_per_quantum);
        PassResult pass = carry(run, direct, state);
        end_pass(run, direct, state, pass);
        const double passed = watch.lap();
        seconds.global += passed;
        seconds.serial += passed - (seconds_in_loops() - loops_before);

        // Gather along fresh lines what all patches send by then.
        closing_gather(run, state, pass);
        if (group > 0 && !pass.whole) {
            estimate.stop();
            break;
        }
        estimate.add(run, direct, pass);
        banks.clear(plan.threads);
        seconds.gather += watch.lap();
        if (listener.stopped()) {
            if (group + 1 < plan.groups)
                estimate.stop();
            break;
        }
    }

    // The groups' mean is the result, their spread its error.
    Watch watch;
    Solution solution = estimate.solution(plan);
    seconds.gather += watch.lap();
    solution.seconds = seconds;
    return solution;
}

}  // namespace parallux
