#include <algorithm>
#include <cstdio>

#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "parallux/tables.h"
#include "vectors.h"

namespace parallux {

namespace {

using Json = nlohmann::ordered_json;

double ratio(double numerator, double denominator) {
    return denominator > 0 ? numerator / denominator : 0;
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

/// Watts per band; nothing at all is the integer 0, so that a closed balance reads as one.
Json watts(const std::vector<std::int64_t>& quanta, double watts_per_quantum) {
    Json result = Json::array();
    for (std::int64_t q : quanta)
        result.push_back(q == 0 ? Json(0) : Json(static_cast<double>(q) * watts_per_quantum));
    return result;
}

Json energy(const Balance& balance) {
    Json result, quanta;
    quanta["watts_per_quantum"] = balance.watts_per_quantum;
    auto add = [&](const char* key, const std::vector<std::int64_t>& values) {
        result[key] = watts(values, balance.watts_per_quantum);
        quanta[key] = values;
    };
    add("emitted", balance.emitted);
    add("absorbed", balance.absorbed);
    add("escaped", balance.escaped);
    add("unshot", balance.unshot);
    add("residual", balance.residual);
    result["quanta"] = quanta;
    return result;
}

Json seconds_of(const Seconds& seconds) {
    return {{"load", seconds.load},
            {"patches", seconds.patches},
            {"first_shot", seconds.first_shot},
            {"global", seconds.global},
            {"serial", seconds.serial},
            {"gather", seconds.gather},
            {"output", seconds.output},
            {"total", seconds.total}};
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::vector<std::string> all_warnings(const Scene& scene, const Solution& solution) {
    std::vector<std::string> result = scene.warnings;
    result.insert(result.end(), solution.warnings.begin(), solution.warnings.end());
    return result;
}

}  // namespace

void write_stats(const std::filesystem::path& file, const Scene& scene, const Patches& patches,
                 const SolveSettings& settings, const Solution& solution) {
    const LineCounts& counts = solution.counts;
    const double lines = static_cast<double>(counts.lines);
    const double hits = static_cast<double>(counts.hits);
    Json stats;
    stats["scene"] = scene.file.string();
    stats["patches"] = patches.count();
    stats["surfaces"] = scene.surfaces.size();
    stats["bands"] = solution.bands;
    stats["method"] = method_name(settings.method);
    stats["seed"] = settings.seed;
    stats["threads"] = solution.threads;
    stats["bundles"] = solution.bundles;
    stats["lines"] = counts.lines;
    stats["line_spacing"] = solution.line_spacing;
    stats["batch"] = solution.batch;
    stats["first_shot_rays"] = solution.first_shot_rays;
    stats["shots"] = solution.shots;
    stats["hits"] = counts.hits;
    stats["transfers"] = counts.transfers;
    stats["average_list"] = ratio(hits, lines);
    stats["average_nonempty_list"] = ratio(hits, static_cast<double>(counts.nonempty));
    stats["leaks"] = solution.leaks;
    stats["seconds"] = seconds_of(solution.seconds);
    stats["lines_per_second"] = ratio(lines, solution.seconds.global + solution.seconds.gather);
    stats["peak_memory_bytes"] = peak_memory();
    stats["predicted_memory_bytes"] = nullptr;
    if (solution.predicted_memory > 0)
        stats["predicted_memory_bytes"] = solution.predicted_memory;
    stats["energy"] = energy(solution.energy);
    // Of one group alone nothing is known: null rather than a number that nobody has measured.
    stats["groups"] = solution.groups;
    stats["error"] = {{"relative_rms", nullptr},
                      {"relative_rms_bound", nullptr},
                      {"target", nullptr},
                      {"confidence", nullptr}};
    if (solution.groups > 1) {
        stats["error"]["relative_rms"] = solution.relative_rms;
        stats["error"]["relative_rms_bound"] = solution.relative_rms_bound;
        stats["error"]["confidence"] = 0.95;
    }
    if (settings.target_error > 0)
        stats["error"]["target"] = settings.target_error;
    stats["solution_hash"] = hash_text(solution.hash);
    stats["partial"] = solution.partial;
    stats["version"] = PARALLUX_VERSION;
    stats["isa"] = vectors_in_use();
    stats["warnings"] = all_warnings(scene, solution);

    OutputFile output(file);
    // File names may hold any bytes; JSON may not.
    output.write(stats.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    output.commit();
}

}  // namespace parallux
