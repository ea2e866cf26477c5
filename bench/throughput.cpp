#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "parallux/parallux.h"

// Lines a second of the two line engines, transfers included, timed by solve() from the first batch
// to the last merge. Engines take turns, so that a change of the machine's speed meets both.

using namespace parallux;

namespace {

struct Row {
    std::string engine;
    unsigned threads;
    double lines_per_bundle;
    std::vector<double> rates, hit_rates;  // one a repetition
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure(const Scene& scene, const Patches& patches, std::uint64_t bundles, Row& row) {
    SolveSettings settings;
    settings.method = row.engine == "bundle" ? Method::bundles : Method::lines;
    settings.first_shot = FirstShot::off;
    settings.batch = settings.method == Method::lines ? 16 : 0;  // both from snapshots
    settings.threads = row.threads;
    // Independent lines are slower: a tenth of them is enough to time.
    settings.bundles =
        settings.method == Method::bundles ? bundles : std::max<std::uint64_t>(1, bundles / 10);
    Solution solution = solve(scene, patches, settings);
    row.rates.push_back(static_cast<double>(solution.counts.lines) / solution.seconds.global);
    row.hit_rates.push_back(static_cast<double>(solution.counts.hits) / solution.seconds.global);
    row.lines_per_bundle =
        static_cast<double>(solution.counts.lines) / static_cast<double>(solution.bundles);
}

void print(const std::vector<Row>& rows) {
    std::printf("%-24s %8s %14s %12s %9s\n", "engine", "threads", "lines/bundle", "Mlines/s",
                "spread");
    for (const Row& row : rows) {
        auto [low, high] = std::minmax_element(row.rates.begin(), row.rates.end());
        std::printf("%-24s %8u %14.0f %12.2f %8.0f%%\n", row.engine.c_str(), row.threads,
                    row.lines_per_bundle, median(row.rates) * 1e-6,
                    100 * (*high - *low) / median(row.rates));
    }
}

void write_json(const std::string& file, const std::string& scene, std::size_t patches,
                const std::vector<Row>& rows) {
    nlohmann::ordered_json json{{"rows", nlohmann::ordered_json::array()}};
    for (const Row& row : rows)
        json["rows"].push_back({{"scene", scene},
                                {"engine", row.engine},
                                {"threads", row.threads},
                                {"patches", patches},
                                {"lines_per_bundle", row.lines_per_bundle},
                                {"lines_per_second", median(row.rates)},
                                {"hits_per_second", median(row.hit_rates)}});
    OutputFile output(file);
    output.write(json.dump(2) + "\n");
    output.commit();
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Lines a second of bundles and of independent lines"};
    std::string scene_file = "scenes/paper_12150.json", json;
    std::uint64_t patches_wanted = 0, bundles = 400;
    int repetitions = 5;
    bool tiny = false;
    app.add_option("--scene", scene_file, "Scene file")->capture_default_str();
    app.add_option("--patches", patches_wanted, "Wanted number [as the scene says]");
    app.add_option("--bundles", bundles, "Of each run")->capture_default_str();
    app.add_option("--repetitions", repetitions, "Median of so many runs")->capture_default_str();
    app.add_option("--json", json, "Where to write the rows");
    app.add_flag("--tiny", tiny, "Just run, for ctest");
    CLI11_PARSE(app, argc, argv);
    if (tiny) {
        bundles = 20;
        repetitions = 1;
    }
    try {
        Scene scene = load_scene(scene_file);
        PatchSettings division;
        division.count = patches_wanted;
        Patches patches = make_patches(scene, division);
        std::vector<Row> rows;
        for (const char* engine : {"bundle", "embree-lines-parents"})
            for (unsigned threads : {1u, 2u})
                rows.push_back({engine, threads, 0, {}, {}});
        for (int k = 0; k < repetitions; ++k)
            for (Row& row : rows)
                measure(scene, patches, bundles, row);
        std::printf("%s, %zu patches, %u bands\n", scene_file.c_str(), patches.count(),
                    patches.bands);
        print(rows);
        if (!json.empty())
            write_json(json, scene_file, patches.count(), rows);
    } catch (const Error& error) {
        std::fprintf(stderr, "throughput: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
    return 0;
}
