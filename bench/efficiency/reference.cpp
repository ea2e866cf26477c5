#include "efficiency/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "efficiency/quality.h"
#include "efficiency/reference_file.h"
#include "parallux/solve.h"

namespace parallux::efficiency {

namespace {

// Rays beyond these cost more than they gain here.
constexpr std::uint64_t most_rays = 200'000'000;

struct Part {
    LongRun run;
    std::vector<float> radiosity;
};

Part long_run(const Case& of, const ReferenceSettings& settings, const char* name,
              FirstShot first_shot, std::uint64_t seed) {
    SolveSettings own;
    own.first_shot = first_shot;
    own.first_shot_rays = std::min(most_rays, 250 * settings.bundles);
    own.bundles = settings.bundles;
    own.groups = 8;
    own.seed = seed;
    own.threads = settings.threads;
    const Solution solution = solve(of.scene, of.patches, own);
    const Seconds& seconds = solution.seconds;
    return {{name, seed, settings.bundles, solution.relative_rms, solution.relative_rms_bound,
             seconds.first_shot + seconds.global + seconds.gather},
            solution.radiosity};
}

double squared(double x) {
    return x * x;
}

// Adds a part to the mean, weighted by the inverse of what it states of its variance.
void add(const Case& of, const Part& part, Reference& reference) {
    const double before = squared(reference.stated), own = squared(part.run.relative_rms);
    const double share = reference.radiosity.empty() ? 1 : before / (before + own);
    reference.radiosity.resize(part.radiosity.size(), 0);
    for (std::size_t k = 0; k < part.radiosity.size(); ++k)
        reference.radiosity[k] += share * (part.radiosity[k] - reference.radiosity[k]);
    reference.scale = mean_square(of, [&](std::size_t k) { return reference.radiosity[k]; });
    reference.stated = share < 1 ? std::sqrt(before * own / (before + own)) : part.run.relative_rms;
    reference.bound =
        std::hypot((1 - share) * reference.bound, share * part.run.relative_rms_bound);
    reference.runs.push_back(part.run);
}

// How far a part is from the mean so far, and how far it may be.
Check check(const Case& of, const Part& part, const Reference& reference) {
    Check result;
    result.difference =
        std::sqrt(quadratic_error(of, part.radiosity, reference.radiosity) / reference.scale);
    result.expected = std::hypot(part.run.relative_rms, reference.stated);
    result.bound = std::hypot(part.run.relative_rms_bound, reference.bound);
    return result;
}

Reference compute(const Case& of, const ReferenceSettings& settings) {
    Reference result;
    add(of, long_run(of, settings, "none", FirstShot::off, 7001), result);
    const Part rays = long_run(of, settings, "rays", FirstShot::rays, 7002);
    result.rays = check(of, rays, result);
    add(of, rays, result);
    result.own_error = result.stated;
    if (!exact_is_affordable(of))
        return result;
    const Part exact = long_run(of, settings, "exact", FirstShot::exact, 7003);
    result.exact = check(of, exact, result);
    if (result.exact.agrees()) {
        add(of, exact, result);
        result.own_error = std::hypot(result.stated, result.exact.blind());
    }
    return result;
}

void print_check(const char* what, const Check& check) {
    std::printf("reference: %s %.4f %%, expected %.4f, below %.4f: %s (blind below %.4f)\n", what,
                100 * check.difference, 100 * check.expected, 100 * check.bound,
                check.agrees() ? "compatible" : "NOT COMPATIBLE", 100 * check.blind());
}

}  // namespace

bool exact_is_affordable(const Case& of) {
    return static_cast<double>(of.emitters) * static_cast<double>(of.patches.count()) <= 1e6;
}

Reference make_reference(const Case& of, const ReferenceSettings& settings) {
    Reference reference;
    if (read_reference(of, settings, reference))
        return reference;
    std::printf("\n%s: making its reference, runs of %llu bundles\n", of.name.c_str(),
                static_cast<unsigned long long>(settings.bundles));
    std::fflush(stdout);
    reference = compute(of, settings);
    write_reference(of, settings, reference);
    return reference;
}

void print_reference(const Case& of, const Reference& reference) {
    std::printf("\n%s: %zu patches, %u band%s, %llu emitting surfaces\n", of.name.c_str(),
                of.patches.count(), of.patches.bands, of.patches.bands > 1 ? "s" : "",
                static_cast<unsigned long long>(of.emitters));
    for (const LongRun& run : reference.runs)
        std::printf("reference: %llu bundles, first shot %s, %.0f s: states %.4f %% (below %.4f)\n",
                    static_cast<unsigned long long>(run.bundles), run.first_shot.c_str(),
                    run.seconds, 100 * run.relative_rms, 100 * run.relative_rms_bound);
    print_check("rays from none", reference.rays);
    if (reference.exact.bound > 0)
        print_check("exact from their mean", reference.exact);
    if (!reference.exact.agrees())
        std::printf("reference: the run after an exact first shot is left out\n");
    std::printf("reference: own error %.4f %%%s\n", 100 * reference.own_error,
                reference.cached ? "; kept from an earlier run" : "");
    std::fflush(stdout);
}

}  // namespace parallux::efficiency
