#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "parallux/factors.h"

namespace parallux {

namespace {

using Json = nlohmann::ordered_json;

const char* between_name(FactorNodes between) {
    switch (between) {
        case FactorNodes::patches:
            return "patches";
        case FactorNodes::surfaces:
            return "surfaces";
        case FactorNodes::objects:
            return "objects";
        case FactorNodes::materials:
            return "materials";
    }
    return "";
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

Json errors(const Factors& factors) {
    Json result = {{"groups", factors.groups}, {"rms_factor", nullptr}, {"rms_sky", nullptr}};
    if (!factors.sky_error.empty()) {
        result["rms_factor"] = factors.rms_factor;
        result["rms_sky"] = factors.rms_sky;
    }
    return result;
}

}  // namespace

void write_factor_stats(const std::filesystem::path& file, const Scene& scene,
                        const Patches& patches, const FactorSettings& settings,
                        const Factors& factors, const FactorRun& run) {
    const FactorCheck check = check_factors(factors);
    Json stats;
    stats["scene"] = scene.file.string();
    stats["between"] = between_name(settings.between);
    stats["nodes"] = factors.nodes.size();
    stats["patches"] = patches.count();
    stats["surfaces"] = scene.surfaces.size();
    stats["sky_parts"] = factors.sky_parts;
    stats["sky_from"] = factors.sky_from_points ? "points" : "lines";
    stats["seed"] = settings.seed;
    stats["threads"] = factors.threads;
    stats["bundles"] = factors.bundles;
    stats["line_spacing"] = factors.line_spacing;
    stats["lines"] = factors.counts.lines;
    stats["hits"] = factors.counts.hits;
    stats["pairs"] = factors.counts.transfers;
    stats["entries"] = factors.column.size();
    stats["threshold"] = settings.threshold;
    stats["entries_dropped"] = factors.dropped;
    stats["row_sums"] = {{"largest_deviation", check.row_deviation}};
    stats["reciprocity"] = {{"largest_deviation_m2", check.reciprocity}};
    stats["smallest_factor"] = check.smallest;
    stats["error"] = errors(factors);
    stats["unresolved"] = {{"leaks", factors.leaks},
                           {"odd_lists", factors.counts.odd},
                           {"rows_without_lines", factors.unseen},
                           {"rest_of_area", factors.rest}};
    stats["seconds"] = {{"load", run.load_seconds},       {"patches", run.patches_seconds},
                        {"count", factors.count_seconds}, {"sky", factors.sky_seconds},
                        {"scale", factors.scale_seconds}, {"output", run.output_seconds},
                        {"total", run.total_seconds}};
    stats["bytes"] = run.bytes;
    stats["predicted_memory_bytes"] = factors.predicted_memory;
    stats["peak_memory_bytes"] = peak_memory();
    stats["partial"] = factors.partial;
    stats["version"] = PARALLUX_VERSION;
    stats["warnings"] = scene.warnings;
    for (const std::string& warning : factors.warnings)
        stats["warnings"].push_back(warning);
    OutputFile output(file);
    // File names may hold any bytes; JSON may not.
    output.write(stats.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    output.commit();
}

}  // namespace parallux
