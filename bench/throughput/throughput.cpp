#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "output/output_file.h"
#include "parallux/error.h"
#include "throughput/check.h"
#include "throughput/child.h"
#include "throughput/report.h"
#include "throughput/rounds.h"

// Lines a second of bundles and of Embree's lines, transfers included, on one solve of each scene.

using namespace parallux;
using namespace parallux::throughput;

namespace {

struct Options {
    std::vector<std::string> scenes, engines = engine_names();
    std::vector<unsigned> threads{1, 2};
    CaseSettings settings;
    int repetitions = 5;
    std::string json;
    bool sweep = false, no_memory = false;
};

std::vector<std::string> chosen_scenes(const Options& options) {
    std::vector<std::string> names;
    for (const std::string& name : options.scenes.empty() ? case_names() : options.scenes) {
        if (options.settings.tiny && name == "kitchen")
            continue;
        if (available(name))
            names.push_back(name);
        else
            std::printf("%s: its file is not here; skipped\n", name.c_str());
    }
    return names;
}

// The room's triangles are a patch each; divided, they try what the other scenes do not have.
bool tiny_agrees(const Case& of) {
    bool good = engines_agree(of);
    if (of.name == "room-300000") {
        CaseSettings divided;
        divided.tiny = true;
        divided.patches = 27'000;
        good &= engines_agree(make_case(of.name, divided));
    }
    return good;
}

int run(const Options& options) {
    if (options.sweep) {
        sweep();
        return 0;
    }
    if (!options.json.empty())
        check_writable(options.json);
    // Forking comes first: a child of a process with threads would wait for them for ever.
    const std::vector<std::string> names = chosen_scenes(options);
    const unsigned most = *std::max_element(options.threads.begin(), options.threads.end());
    std::map<std::string, double> bytes_per_patch;
    for (const std::string& name : names)
        if (!options.no_memory)
            bytes_per_patch[name] = run_in_child(name, options.settings, most).bytes_per_patch();
    std::vector<Row> rows;
    bool good = true;
    for (const std::string& name : names) {
        const Case of = make_case(name, options.settings);
        if (options.settings.tiny)
            good &= tiny_agrees(of);
        std::vector<std::unique_ptr<Engine>> engines;
        for (const std::string& engine : options.engines)
            engines.push_back(make_engine(engine, of, options.settings.tiny));
        std::vector<Row> own = run_rounds(of, engines, options.threads, options.repetitions);
        for (Row& row : own)
            if (row.engine == "bundle" && row.threads == most)
                row.bytes_per_patch = bytes_per_patch[name];
        print_rows(own);
        rows.insert(rows.end(), own.begin(), own.end());
    }
    if (!options.json.empty())
        write_json(options.json, rows);
    return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Lines a second of bundles and of lines by Embree"};
    Options options;
    CaseSettings& settings = options.settings;
    app.add_option("--scene", options.scenes,
                   "paper-12150, paper-1200000, room-300000, kitchen or a file [all four]");
    app.add_option("--engines", options.engines, "Which ones")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::IsMember(engine_names()));
    app.add_option("--repetitions", options.repetitions, "Of every engine, taken in turn")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_option("--threads", options.threads, "Numbers of threads")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1u, 1024u));
    app.add_option("--json", options.json, "Where to write the rows");
    app.add_option("--patches", settings.patches, "Wanted number [as the scene's name says]");
    app.add_option("--bundles", settings.bundles, "Of the solve [by the scene]");
    app.add_option("--lines-per-bundle", settings.lines_per_bundle, "Mean [by the scene]")
        ->check(CLI::Range(1.0, 1e10));
    app.add_flag("--no-memory", options.no_memory, "Leave out the run that measures memory");
    app.add_flag("--sweep", options.sweep, "Instead: the paper's scene from 10^4 to 10^7 patches");
    app.add_flag("--tiny", settings.tiny,
                 "Small forms of the scenes; exit code 1 when the engines do not agree");
    CLI11_PARSE(app, argc, argv);
    if (settings.tiny)
        options.repetitions = 1;
    try {
        return run(options);
    } catch (const Error& error) {
        std::fprintf(stderr, "throughput: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
}
