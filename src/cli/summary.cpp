#include "cli/summary.h"

#include <iomanip>
#include <numeric>
#include <sstream>

#include "cli/terminal.h"

namespace parallux {

namespace {

double total(const std::vector<std::int64_t>& quanta) {
    return std::accumulate(quanta.begin(), quanta.end(), 0.0,
                           [](double sum, std::int64_t q) { return sum + static_cast<double>(q); });
}

/// All bands together, as shares of what was emitted.
std::string energy(const Balance& balance) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    const double emitted = total(balance.emitted);
    text << std::setprecision(6) << emitted * balance.watts_per_quantum << " W emitted";
    if (emitted <= 0)
        return text.str();
    auto share = [&](const std::vector<std::int64_t>& part, const char* name) {
        text << ", " << std::setprecision(4) << 100 * total(part) / emitted << " % " << name;
    };
    share(balance.absorbed, "absorbed");
    share(balance.escaped, "escaped");
    share(balance.unshot, "unshot");
    text << (total(balance.residual) == 0 ? "; balance exact" : "; balance NOT closed");
    return text.str();
}

/// What the number of lines leaves open: in which order energy went along them.
std::string how_followed(Method method, const Solution& solution) {
    const std::string bundles = std::to_string(solution.bundles);
    switch (method) {
        case Method::bundles:
            return " in " + bundles + " bundles";
        case Method::lines:
            if (solution.batch == 0)
                return ", one after the other";
            return ", up to " + std::to_string(solution.batch) + "/" + bundles +
                   " of them from one snapshot";
        case Method::progressive:
            return " from patches in " + std::to_string(solution.shots) + " shots";
        case Method::particles:
            return " walked by particles";
        case Method::matrix:
            break;
    }
    return ", counted";
}

std::string error_of(const Solution& solution) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    if (solution.groups > 1)
        text << "error    " << std::setprecision(3) << 100 * solution.relative_rms
             << " % relative RMS, below " << 100 * solution.relative_rms_bound
             << " % with 95 % confidence\n";
    return text.str();
}

std::string wrote(const SolveOptions& options) {
    std::string text;
    for (const std::filesystem::path& file : options.outputs())
        text += "wrote    " + printable(file.string()) + "\n";
    return text;
}

void tell_warnings(const Scene& scene, const Solution& solution) {
    for (const auto* warnings : {&scene.warnings, &solution.warnings})
        for (const std::string& warning : *warnings)
            complain("warning: " + warning);
}

std::string summary(const SolveOptions& options, const Patches& patches, const Solution& solution) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    const LineCounts& counts = solution.counts;
    const double lines = static_cast<double>(counts.lines);
    text << "patches  " << patches.count() << '\n';
    text << "lines    " << counts.lines;
    text << how_followed(options.solve.method, solution);
    const double seconds = solution.seconds.global + solution.seconds.gather;
    if (seconds > 0)
        text << ", " << std::setprecision(3) << lines / seconds / 1e6 << " M lines/s on "
             << solution.threads << " threads";
    text << '\n';
    text << "energy   " << energy(solution.energy) << '\n';
    text << error_of(solution);
    text << "leaks    " << solution.leaks << '\n';
    text << "time     " << std::fixed << std::setprecision(2) << solution.seconds.total << " s\n";
    text << wrote(options);
    if (solution.partial)
        text << "partial  stopped before all lines were done\n";
    return text.str();
}

}  // namespace

void tell_reuse(const SolveOptions& options, const Scene& scene, const Patches& patches,
                const SavedSolution& result) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    const Solution& solution = result.solution;
    text << "patches  " << patches.count() << '\n' << error_of(solution) << wrote(options);
    if (solution.partial)
        text << "partial  the solve stopped before all lines were done\n";
    print(text.str());
    tell_warnings(scene, solution);
}

void tell_memory(std::uint64_t bytes) {
    // Where nobody can be told, the summary will find out, once the outputs are there.
    (void)try_print("memory   " + std::to_string((bytes >> 20) + 1) +
                    " MiB at most, but for outputs\n");
}

void tell_summary(const SolveOptions& options, const Scene& scene, const Patches& patches,
                  const Solution& solution) {
    print(summary(options, patches, solution));
    tell_warnings(scene, solution);
}

std::string describe_fluxes(const Fluxes& fluxes) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "fluxes   " << std::setprecision(6) << fluxes.leaving << " W net out of the scene";
    if (fluxes.imbalance != 0)
        text << ", " << std::setprecision(3) << fluxes.imbalance << " W";
    if (fluxes.leaving_stderr > 0)
        text << " ± " << std::setprecision(2) << fluxes.leaving_stderr << " W";
    if (fluxes.imbalance != 0)
        text << " before the errors were shared out";
    text << '\n';
    return text.str();
}

std::string describe_comparison(const Comparison& comparison) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "patches       " << comparison.patches << '\n'
         << "RMS           " << comparison.rms << " W/m²\n"
         << "relative RMS  " << comparison.relative_rms << '\n'
         << "maximum       " << comparison.maximum << " W/m² at patch " << comparison.maximum_patch
         << '\n';
    return text.str();
}

}  // namespace parallux
