#include "efficiency/reference.h"

#include <cmath>
#include <cstdio>

#include "efficiency/quality.h"
#include "efficiency/reference_file.h"
#include "parallux/solve.h"

namespace parallux::efficiency {

namespace {

struct Planned {
    const char* name;
    FirstShot first_shot;
    std::uint64_t seed;
};

Solution long_run(const Case& of, const ReferenceSettings& settings, const Planned& planned,
                  LongRun& run) {
    SolveSettings own;
    own.first_shot = planned.first_shot;
    own.bundles = settings.bundles;
    own.groups = 8;
    own.seed = planned.seed;
    own.threads = settings.threads;
    Solution solution = solve(of.scene, of.patches, own);
    const Seconds& seconds = solution.seconds;
    run = {planned.name,
           planned.seed,
           settings.bundles,
           solution.relative_rms,
           solution.relative_rms_bound,
           seconds.first_shot + seconds.global + seconds.gather};
    return solution;
}

// The mean of two runs, and their check of each other.
Reference join(const Case& of, const Solution& a, const Solution& b, const LongRun& run_a,
               const LongRun& run_b) {
    Reference result;
    result.runs = {run_a, run_b};
    auto squared = [](double x) { return x * x; };
    const double variance_a = squared(run_a.relative_rms);
    const double variance_b = squared(run_b.relative_rms);
    const double share_a = variance_b / (variance_a + variance_b);
    for (std::size_t k = 0; k < a.radiosity.size(); ++k)
        result.radiosity.push_back(share_a * a.radiosity[k] + (1 - share_a) * b.radiosity[k]);
    result.scale = mean_square(of, [&](std::size_t k) { return result.radiosity[k]; });
    result.quadratic_error = result.scale * variance_a * variance_b / (variance_a + variance_b);
    result.difference = std::sqrt(quadratic_error(of, a.radiosity, b.radiosity) / result.scale);
    result.stated = std::sqrt(variance_a + variance_b);
    result.bound = std::hypot(run_a.relative_rms_bound, run_b.relative_rms_bound);
    return result;
}

Reference compute(const Case& of, const ReferenceSettings& settings) {
    LongRun run, run_none;
    const Solution none = long_run(of, settings, {"none", FirstShot::off, 7002}, run_none);
    double refused = 0;
    if (exact_is_affordable(of)) {
        const Solution exact = long_run(of, settings, {"exact", FirstShot::exact, 7001}, run);
        Reference result = join(of, exact, none, run, run_none);
        if (result.agrees())
            return result;
        refused = result.difference;
    }
    const Solution again = long_run(of, settings, {"none", FirstShot::off, 7003}, run);
    Reference result = join(of, again, none, run, run_none);
    result.refused = refused;
    return result;
}

}  // namespace

bool exact_is_affordable(const Case& of) {
    return static_cast<double>(of.emitters) * static_cast<double>(of.patches.count()) <= 1e6;
}

Reference make_reference(const Case& of, const ReferenceSettings& settings) {
    Reference reference;
    if (read_reference(of, settings, reference))
        return reference;
    std::printf("\n%s: making its reference, two runs of %llu bundles\n", of.name.c_str(),
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
    std::printf(
        "reference: they differ by %.4f %%, their statements let expect %.4f, below %.4f: "
        "%s; a systematic error of one below %.4f %% would not show\n",
        100 * reference.difference, 100 * reference.stated, 100 * reference.bound,
        reference.agrees() ? "compatible" : "NOT COMPATIBLE", 100 * reference.blind());
    if (reference.refused > 0)
        std::printf(
            "reference: a run after an exact first shot is NOT COMPATIBLE, it is %.4f %% "
            "from the first of these: left out\n",
            100 * reference.refused);
    std::printf("reference: own error %.4f %%%s\n",
                100 * std::sqrt(reference.quadratic_error / reference.scale),
                reference.cached ? "; kept from an earlier run" : "");
    std::fflush(stdout);
}

}  // namespace parallux::efficiency
