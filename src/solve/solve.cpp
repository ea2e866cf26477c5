#include "parallux/solve.h"

#include <memory>

#include "lines/periodic.h"
#include "materials/walk.h"
#include "parallel.h"
#include "reference/matrix.h"
#include "reference/particles.h"
#include "reference/progressive.h"
#include "solve/checkpoint.h"
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
void carry(const Run& run, Group& group) {
    switch (run.settings.method) {
        case Method::lines:
            if (run.plan.batch > 0)
                break;
            group.pass = in_order_pass(run, group.direct, group.state);
            return;
        case Method::progressive:
            group.pass = progressive_pass(run, group.direct);
            return;
        case Method::particles:
            group.pass = particle_pass(run, group.direct, group.state);
            return;
        case Method::matrix:
            group.pass = matrix_pass(run, group.direct, group.state);
            return;
        case Method::bundles:
            break;
    }
    global_pass(run, group);
}

// One group: first shot, pass and gather under a seed of its own, into the estimate. A group that
// is taken up again goes on with the stage it is in.
void run_group(const Run& run, Group& group, Estimate& estimate, Seconds& seconds) {
    // Shoot the light of the sources locally.
    Watch watch;
    if (group.stage < Stage::pass) {
        first_shot(run, group);
        group.enter(Stage::pass);
    }
    seconds.first_shot += watch.lap();

    // Send what is left unshot along global lines, or by a reference method.
    if (group.stage == Stage::pass) {
        const double loops_before = seconds_in_loops();
        if (group.state.bands == 0)
            group.state = dark_state(run.patches, run.plan.watts_per_quantum);
        carry(run, group);
        end_pass(run, group.direct, group.state, group.pass);
        group.small = small_patches(run, group.state, group.pass);
        group.enter(Stage::local_paths);
        const double passed = watch.lap();
        seconds.global += passed;
        seconds.serial += passed - (seconds_in_loops() - loops_before);
    }

    // Gather along fresh lines what all patches send by then, and along local rays where patches
    // are too small for lines.
    if (group.stage == Stage::local_paths) {
        gather_locally(run, group);
        group.enter(Stage::gather);
    }
    if (group.stage == Stage::gather) {
        closing_gather(run, group, numbers_of(group.small));
        group.enter(Stage::local_rays);
    }
    shoot_locally(run, group);
    if (estimate.groups() == 0 || group.pass.whole)
        estimate.add(run, group.direct, group.pass);
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
    std::unique_ptr<Walks> walks;
    if (!patches.specular.empty())
        walks = std::make_unique<Walks>(scene, patches, *rays);
    const Regions regions = make_regions(scene, patches, plan.keeping.regions, plan.keeping.groups);
    Group group;
    Estimate estimate(patches);
    Seconds seconds;
    Watch watch;

    // Take up a run that was interrupted, and have this one kept.
    Checkpoint checkpoint(scene, patches, settings, regions,
                          {plan, rounds, estimate, group, seconds, banks});
    checkpoint.resume();
    listener.keep_by([&](bool last) { checkpoint.keep(last); });
    Team team(plan.threads);
    SolveSettings own = settings;
    Run run{scene, patches, own, plan, rays.get(), banks, listener, nullptr, &regions, walks.get()};
    if (group.stage == Stage::trial) {
        if (plan.try_rays && rays)
            plan = make_plan(scene, patches, settings, try_rays(run, group.done));
        group.begin(true);
    }
    const std::unique_ptr<ExactShot> exact =
        prepare_exact(scene, patches, rays.get(), plan, listener);
    run.exact = exact.get();
    seconds.first_shot += watch.lap();
    for (;;) {
        // Run groups of their own seeds, each a whole solution; one is begun in any case.
        const std::uint32_t last = rounds.groups_before() + plan.groups;
        const std::uint64_t end = estimate.bundles() + (last - estimate.groups()) * plan.bundles;
        while (estimate.groups() < last && (estimate.groups() == 0 || !listener.stopped())) {
            showing.between_groups(estimate, plan, seconds);
            own.seed = group_seed(settings.seed, estimate.groups());
            const auto from = static_cast<double>(estimate.bundles());
            listener.begin_part(
                from / static_cast<double>(end),
                (from + static_cast<double>(plan.bundles)) / static_cast<double>(end));
            run_group(run, group, estimate, seconds);
            group.begin(plan.shoot_each);
        }
        if (estimate.bundles() < end) {
            estimate.stop();
            break;
        }
        // Where an error is wanted, go on with as much as is missing.
        if (!rounds.another(estimate, seconds, listener, plan))
            break;
    }
    checkpoint.finish();

    // The groups' mean is the result, their spread its error.
    watch.lap();
    Solution solution = estimate.solution(plan);
    if (const std::string tilted = tilt_warning(scene); !tilted.empty())
        solution.warnings.push_back(tilted);
    seconds.gather += watch.lap();
    solution.seconds = seconds;
    solution.predicted_memory = predicted_memory(scene, patches, settings);
    return solution;
}

}  // namespace parallux
