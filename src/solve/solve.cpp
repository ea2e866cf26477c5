#include "parallux/solve.h"

#include <memory>

#include "parallel.h"
#include "reference/matrix.h"
#include "reference/particles.h"
#include "reference/progressive.h"
#include "solve/closing_gather.h"
#include "solve/first_shot.h"
#include "solve/global_pass.h"
#include "solve/in_order_pass.h"
#include "solve/run.h"
#include "solve/solution.h"

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

    // Shoot the light of the sources locally.
    Watch first_watch;
    std::unique_ptr<RayScene> rays;
    if (needs_rays(scene, patches, settings))
        rays = std::make_unique<RayScene>(scene, plan.threads);
    Team team(plan.threads);
    Run run{scene, patches, settings, plan, rays.get(), banks, listener};
    DirectLight direct = first_shot(run);
    seconds.first_shot = first_watch.seconds();

    // Send what is left unshot along global lines, or by a reference method.
    Watch global_watch;
    TransferState state = dark_state(patches, plan.watts_per_quantum);
    PassResult pass = carry(run, direct, state);
    end_pass(run, direct, state, pass);
    seconds.global = global_watch.seconds();

    // Gather along fresh lines what all patches send by then, and turn it into watts.
    Watch gather_watch;
    closing_gather(run, state, pass);
    Solution solution = solution_of(run, direct, pass);
    solution.seconds = seconds;
    solution.seconds.gather = gather_watch.seconds();
    return solution;
}

}  // namespace parallux
