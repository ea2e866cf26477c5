#include <cstdlib>
#include <functional>
#include <optional>

#include "cli/factors.h"
#include "cli/info.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/prepare.h"
#include "cli/progress.h"
#include "cli/refresh.h"
#include "cli/summary.h"
#include "cli/terminal.h"

using namespace parallux;

namespace {

constexpr int exit_above_tolerance = 1;

// Says so where it is not.
bool target_met(const SolveSettings& settings, const Solution& solution) {
    const bool known = solution.groups > 1;
    if (settings.target_error <= 0 ||
        (known && solution.relative_rms_bound <= settings.target_error))
        return true;
    complain("parallux: target not met: " +
             (known ? "with 95 % confidence the error is only below " +
                          percent(solution.relative_rms_bound)
                    : std::string("the error is not known")) +
             ", " + percent(settings.target_error) + " was wanted" +
             (settings.time_limit > 0 ? "; a longer --time-limit would help" : ""));
    return false;
}

int solve_scene(SolveOptions options) {
    Prepared prepared = prepare(options);
    auto& [scene, patches, measured, loaded, divided] = prepared;

    if (!options.quiet)
        tell_memory(predicted_memory(scene, patches, options.solve));
    keep_results();
    ProgressReport report(options.progress, options.quiet);
    Refresh refresh(options, scene, patches, report);
    std::optional<FluxMeter> meter;
    if (!options.fluxes.empty())
        meter.emplace(scene, patches, options.flux_unit);
    std::string unkept;  // why the last checkpoint could not be written
    options.solve.checkpoints.wanted = checkpoint_wanted;
    options.solve.checkpoints.written = [&](const std::string& failure) {
        if (!failure.empty() && unkept.empty()) {
            report.end();
            complain("warning: " + failure + "; the run goes on without this checkpoint");
        }
        unkept = failure;
    };
    Solution solution = solve(scene, patches, options.solve, std::ref(report),
                              meter ? meter->preview() : refresh.preview());
    report.end();
    if (meter)
        measured.fluxes = meter->fluxes(solution);
    solution.seconds.load = loaded;
    solution.seconds.patches = divided - loaded;

    write_outputs(options, scene, patches, solution, measured);
    if (!options.quiet)
        tell_summary(options, scene, patches, solution);
    if (!options.quiet && meter)
        print(describe_fluxes(measured.fluxes));
    const std::filesystem::path& kept = options.solve.checkpoints.file;
    if (solution.partial && !kept.empty() && !unkept.empty())
        throw Error(Fault::output, unkept + "; the run cannot be taken up again from here");
    const std::string how =
        solution.partial && !kept.empty() ? "; to go on: --resume " + kept.string() : "";
    if (interrupted()) {
        complain("parallux: interrupted; the outputs hold what was done until then" + how);
        return exit_interrupted;
    }
    if (!how.empty() && !options.quiet)
        complain("parallux: stopped before its end" + how);
    return target_met(options.solve, solution) ? 0 : exit_above_tolerance;
}

int compare(const CompareOptions& options) {
    const Comparison comparison = compare_tables(options.a, options.b);
    print(describe_comparison(comparison));
    if (options.tolerance < 0 || comparison.relative_rms <= options.tolerance)
        return 0;
    complain("parallux: " + options.a.string() + ": the relative RMS is above the tolerance");
    return exit_above_tolerance;
}

int run(const Options& options) {
    switch (options.command) {
        case Command::info:
            print(describe_scene(load_scene(options.info.scene, options.info.load), options.info));
            return 0;
        case Command::solve:
            return solve_scene(options.solve);
        case Command::reuse:
            return reuse_result(options.reuse);
        case Command::factors:
            return find_factors(options.factors);
        case Command::compare:
            return compare(options.compare);
        case Command::print:
            print(options.text);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        guard_standard_streams();
        end_cleanly();
        watch_signals();
        return run(parse_options(argc, argv));
    } catch (...) {
        // A library that was left half-way by an exception need not stand its own end.
        std::_Exit(report_failure());
    }
}
