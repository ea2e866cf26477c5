#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "error_bars/parts.h"
#include "error_bars/places.h"
#include "output/output_file.h"
#include "parallux/error.h"

// How far stated errors can be trusted, on whole scenes.

using namespace parallux;
using namespace parallux::error_bars;

namespace {

struct Part {
    const char* name;
    Outcome (*run)(const Options&);
};

constexpr Part all_parts[] = {
    {"coverage", coverage}, {"target", target}, {"bias", bias}, {"slope", slope}};

std::vector<std::string> part_names() {
    std::vector<std::string> names;
    for (const Part& part : all_parts)
        names.push_back(part.name);
    return names;
}

int run(const Options& options, const std::vector<std::string>& names, const std::string& file) {
    if (!file.empty())
        check_writable(file);
    Json json;
    bool good = true;
    for (const Part& part : all_parts) {
        if (std::find(names.begin(), names.end(), part.name) == names.end())
            continue;
        Outcome outcome = part.run(options);
        good = good && outcome.good;
        json[part.name] = std::move(outcome.json);
    }
    if (!file.empty()) {
        OutputFile output(file);
        output.write(json.dump(2) + "\n");
        output.commit();
    }
    return good ? 0 : 1;
}

void add_settings(CLI::App& app, SolveSettings& settings) {
    app.add_option("--lines-per-patch", settings.lines_per_patch, "Of every run [chosen]");
    app.add_option("--gather-share", settings.gather_share, "Of every run [chosen]");
    app.add_option("--batch", settings.batch, "Of every run [chosen]");
    app.add_option("--groups", settings.groups, "Of every run of slope [chosen]");
    const std::map<std::string, FirstShot> shots{
        {"rays", FirstShot::rays}, {"exact", FirstShot::exact}, {"none", FirstShot::off}};
    app.add_option("--first-shot", settings.first_shot, "Of all parts but slope [chosen]")
        ->transform(CLI::CheckedTransformer(shots));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"How far stated errors can be trusted; exit code 1 when a bound does not hold"};
    Options options;
    std::vector<std::string> parts = part_names();
    std::string json;
    app.add_option("parts", parts, "Which ones: coverage, target, bias, slope [all]")
        ->check(CLI::IsMember(part_names()));
    std::vector<std::string> scenes = interval_places();
    for (const std::string& name : slope_places())
        scenes.push_back(name);
    app.add_option("--scene", options.scenes, "Which ones [the part's own]")
        ->delimiter(',')
        ->check(CLI::IsMember(scenes));
    app.add_option("--variants", options.variants,
                   "Of slope: lattice, lattice-unshot, random, random-unshot [all]")
        ->delimiter(',');
    app.add_option("--seeds", options.seeds, "Runs of each kind [2000, 100, 256, 16]");
    app.add_option("--threads", options.threads, "Runs at once [all cores]");
    app.add_option("--bundles", options.bundles, "Of a run of coverage and bias [2048]");
    app.add_option("--times", options.times, "How much longer a reference is")
        ->capture_default_str();
    app.add_option("--growth", options.growth,
                   "Of slope: lines a patch go as bundles to this power, as set at 1024 [0]");
    app.add_option("--json", json, "Where to write what was measured");
    app.add_flag("--tiny", options.tiny, "Few runs, a few seconds");
    add_settings(app, options.settings);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(options, parts, json);
    } catch (const Error& error) {
        std::fprintf(stderr, "error_bars: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
}
