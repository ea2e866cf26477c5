#include "cli/factors.h"

#include <functional>
#include <iomanip>
#include <sstream>

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "output/output_file.h"
#include "parallux/changes.h"
#include "parallux/error.h"

namespace parallux {

namespace {

std::vector<std::filesystem::path> files_of(const FactorsOptions& options) {
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::path& file :
         {options.matrix, options.areas(), options.sky, options.stats})
        if (!file.empty())
            files.push_back(file);
    return files;
}

void write_files(const FactorsOptions& options, const Scene& scene, const Patches& patches,
                 const Factors& factors, FactorRun& run) {
    const double before = seconds_since_start();
    auto write = [&](const std::filesystem::path& file, auto&& writer) {
        if (file.empty())
            return;
        writer(file);
        run.bytes += std::filesystem::file_size(file);
    };
    write(options.matrix, [&](auto& f) { write_factors(f, factors, options.values); });
    write(options.areas(), [&](auto& f) { write_factor_areas(f, factors); });
    write(options.sky, [&](auto& f) { write_sky_factors(f, factors); });
    run.total_seconds = seconds_since_start();
    run.output_seconds = run.total_seconds - before;
    write(options.stats,
          [&](auto& f) { write_factor_stats(f, scene, patches, options.factors, factors, run); });
}

std::string summary(const FactorsOptions& options, const Factors& factors, const FactorRun& run) {
    const FactorCheck check = check_factors(factors);
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "rows     " << factors.nodes.size() << ", " << factors.column.size() << " entries\n";
    text << "lines    " << factors.counts.lines << " in " << factors.bundles << " bundles\n"
         << std::setprecision(3);
    text << "closure  rows and outside come to 1 within " << check.row_deviation
         << "; reciprocal within " << check.reciprocity << " m²\n";
    if (!factors.sky_error.empty())
        text << "error    " << factors.rms_factor << " RMS of a row's factors, " << factors.rms_sky
             << " of its sky\n";
    text << "leaks    " << factors.leaks << '\n';
    text << "memory   " << (factors.predicted_memory >> 20) << " MiB predicted\n";
    text << "time     " << std::fixed << std::setprecision(2) << run.total_seconds << " s\n";
    for (const std::filesystem::path& file : files_of(options))
        text << "wrote    " << printable(file.string()) << '\n';
    if (factors.partial)
        text << "partial  stopped before all lines were done\n";
    return text.str();
}

}  // namespace

int find_factors(const FactorsOptions& options) {
    check_files(files_of(options), {options.scene}, options.scene);
    FactorRun run;
    Scene scene = load_scene(options.scene, options.load);
    if (!options.exclude.empty())
        exclude_surfaces(scene, options.exclude);
    run.load_seconds = seconds_since_start();
    const Patches patches = make_patches(scene, options.patches);
    run.patches_seconds = seconds_since_start() - run.load_seconds;

    keep_results();
    ProgressReport report(options.quiet ? ProgressMode::off : ProgressMode::automatic,
                          options.quiet);
    const Factors factors = view_factors(scene, patches, options.factors, std::ref(report));
    report.end();

    write_files(options, scene, patches, factors, run);
    if (!options.quiet) {
        print(summary(options, factors, run));
        for (const std::vector<std::string>& warnings : {scene.warnings, factors.warnings})
            for (const std::string& warning : warnings)
                complain("warning: " + warning);
    }
    if (!interrupted())
        return 0;
    complain("parallux: interrupted; the outputs hold what was done until then");
    return exit_interrupted;
}

}  // namespace parallux
