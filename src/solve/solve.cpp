#include "parallux/solve.h"

#include <memory>

#include "lines/periodic.h"
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
#include "solve/local_gather.h"
#include "solve/plan_shots.h"
#include "solve/regions.h"
#include "solve/rounds.h"
#include "solve/run.h"
#include "solve/showing.h"

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

// One group: first shot, pass and gather under a seed of its own, into the estimate.
void run_group(const Run& run, DirectLight& direct, Estimate& estimate, Seconds& seconds) {
    // Shoot the light of the sources locally.
    Watch watch;
    if (estimate.groups() == 0 || run.plan.shoot_each)
        direct = first_shot(run);
    seconds.first_shot += watch.lap();

    // Send what is left unshot along global lines, or by a reference method.
    const double loops_before = seconds_in_loops();
    TransferState state = dark_state(run.patches, run.plan.watts_per_quantum);
    PassResult pass = carry(run, direct, state);
    end_pass(run, direct, state, pass);
    const double passed = watch.lap();
    seconds.global += passed;
    seconds.serial += passed - (seconds_in_loops() - loops_before);

    // Gather along fresh lines what all patches send by then, and along local rays where patches
    // are too small for lines.
    std::vector<SmallPatch> small = small_patches(run, state, pass);
    gather_locally(run, state, pass, small);
    closing_gather(run, state, numbers_of(small), pass);
    shoot_locally(run, state, small, pass);
    if (estimate.groups() == 0 || pass.whole)
        estimate.add(run, direct, pass);
    run.banks.clear(run.plan.threads);
    seconds.gather += watch.lap();
}

}  // namespace

Solution solve(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const ProgressCallback& progress, const Preview& preview) {
    // Settle every number of the run.
    Plan plan = make_plan(scene, patches, settings);
    Rounds rounds(scene, patches, settings, plan);
    Listener listener(progress, settings.time_limit);
    Showing showing(preview);
    Banks banks(patches.count(), patches.bands, plan.threads, plan.bank_bytes);
    std::unique_ptr<RayScene> rays;
    if (needs_rays(scene, patches, settings))
        rays = std::make_unique<RayScene>(scene, plan.threads);
    const Regions regions = make_regions(scene, patches, plan.keeping.regions, plan.keeping.groups);
    Team team(plan.threads);
    DirectLight direct;
    Estimate estimate(patches);
    Seconds seconds;
    Watch watch;
    if (plan.try_rays && rays)
        try_rays(scene, patches, settings, *rays, banks, listener, plan);
    const std::unique_ptr<ExactShot> exact = prepare_exact(scene, patches, rays.get(), plan);
    seconds.first_shot += watch.lap();
    SolveSettings own = settings;
    for (;;) {
        // Run groups of their own seeds, each a whole solution.
        const std::uint64_t before = estimate.bundles();
        const auto end = static_cast<double>(before + plan.groups * plan.bundles);
        for (std::uint32_t group = 0; group < plan.groups && !listener.stopped(); ++group) {
            showing.between_groups(estimate, plan, seconds);
            own.seed = group_seed(settings.seed, estimate.groups());
            const auto from = static_cast<double>(before + group * plan.bundles);
            listener.begin_part(from / end, (from + static_cast<double>(plan.bundles)) / end);
            run_group(
                {scene, patches, own, plan, rays.get(), banks, listener, exact.get(), &regions},
                direct, estimate, seconds);
        }
        if (estimate.bundles() < before + plan.groups * plan.bundles) {
            estimate.stop();
            break;
        }
        // Where an error is wanted, go on with as much as is missing.
        if (!rounds.another(estimate, seconds, listener, plan))
            break;
    }

    // The groups' mean is the result, their spread its error.
    watch.lap();
    Solution solution = estimate.solution(plan);
    if (const std::string tilted = tilt_warning(scene); !tilted.empty())
        solution.warnings.push_back(tilted);
    seconds.gather += watch.lap();
    solution.seconds = seconds;
    return solution;
}

}  // namespace parallux
