#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "efficiency/check.h"
#include "efficiency/gains.h"
#include "efficiency/report.h"
#include "output/output_file.h"
#include "parallux/error.h"

// Quadratic error × time of every method, on the same scenes, against references of our own.

using namespace parallux;
using namespace parallux::efficiency;

namespace {

struct Options {
    std::vector<std::string> scenes, methods;
    unsigned threads = 1;
    RoundSettings rounds;
    ReferenceSettings references;
    double longest_goal = 4;
    std::string json, figures;
    bool processor_time = false, references_only = false, tiny = false;
};

std::vector<std::string> chosen_scenes(const Options& options) {
    if (options.tiny)
        return {tiny_case};
    std::vector<std::string> names;
    for (const std::string& name : options.scenes.empty() ? case_names() : options.scenes) {
        if (available(name))
            names.push_back(name);
        else
            std::printf("%s: its file is not here; skipped\n", name.c_str());
    }
    return names;
}

// How long the default method needs to be good to 1 % and to 0.1 %.
std::vector<Goal> find_goals(const Case& of, const Reference& reference,
                             const std::vector<Contender>& all, const std::vector<Row>& rows,
                             const Options& options) {
    std::vector<Goal> goals;
    for (const Contender& contender : all)
        if (contender.name == default_method)
            for (double wanted : {0.01, 0.001})
                goals.push_back(find_goal(of, reference, contender, rows, wanted,
                                          options.longest_goal, options.rounds));
    return goals;
}

int run(const Options& options) {
    if (!options.json.empty())
        check_writable(options.json);
    std::vector<Row> rows;
    std::vector<Goal> goals;
    bool good = true;
    // What there is, should the run end before the last scene.
    auto save = [&] {
        if (!options.json.empty())
            write_json(options.json, rows, goals, options.rounds.clock);
    };
    for (const std::string& name : chosen_scenes(options)) {
        const Case of = make_case(name);
        const Reference reference = make_reference(of, options.references);
        print_reference(of, reference);
        if (options.references_only)
            continue;
        const std::vector<Contender> all = contenders(of, options.threads, options.methods);
        std::vector<Row> own = run_rounds(of, reference, all, options.rounds);
        set_gains(own);
        print_rows(own, options.rounds.seeds, options.rounds.clock);
        if (options.tiny)
            good &= methods_agree(reference, own);
        if (!options.figures.empty())
            write_curves(options.figures, own);
        rows.insert(rows.end(), own.begin(), own.end());
        save();
        if (options.rounds.lengths > 1 && !options.tiny) {
            const std::vector<Goal> found = find_goals(of, reference, all, own, options);
            print_goals(found);
            goals.insert(goals.end(), found.begin(), found.end());
        }
        save();
    }
    return good ? 0 : 1;
}

// Lengths of some milliseconds, the same on every machine, and many runs of them.
void make_tiny(Options& options) {
    options.rounds.seeds = 8;
    options.rounds.lengths = 2;
    options.rounds.shortest = 0;
    options.references.bundles = 65'536;
    options.references.folder += "-tiny";
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Quadratic error x time of every method, on the same scenes"};
    Options options;
    RoundSettings& rounds = options.rounds;
    options.references.folder =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "efficiency-references";
    app.add_option("--scene", options.scenes,
                   "paper-12150, paper-12150-rho80, cornell-1000, cornell-10000, mgf-classroom, "
                   "cornell-nvpro, bitterli-modern-hall or a file [all]");
    app.add_option("--methods", options.methods,
                   "Those to run beside the baseline, by the names that the table has [all]")
        ->delimiter(',');
    app.add_option("--seeds", rounds.seeds, "Runs of every method and length")
        ->capture_default_str()
        ->check(CLI::Range(2, 1000));
    app.add_option("--lengths", rounds.lengths, "Of every method, each four times the one before")
        ->capture_default_str()
        ->check(CLI::Range(1, 8));
    app.add_option("--shortest", rounds.shortest, "Seconds of the shortest, without its set-up")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1000.0));
    app.add_option("--threads", options.threads, "Of all methods but the baseline, which has one")
        ->capture_default_str()
        ->check(CLI::Range(1u, 1024u));
    app.add_flag("--processor-time", options.processor_time,
                 "Seconds of the threads, not of the wall: for busy machines and one thread");
    app.add_option("--json", options.json, "Where to write the rows");
    app.add_option("--figures", options.figures, "A folder for curves, which figures.gp draws")
        ->check(CLI::ExistingDirectory);
    app.add_option("--references", options.references.folder, "A folder where they are kept")
        ->capture_default_str();
    app.add_option("--reference-bundles", options.references.bundles, "Of each of its two runs")
        ->capture_default_str()
        ->check(CLI::Range(std::uint64_t(8192), std::uint64_t(1) << 32));
    app.add_option("--reference-threads", options.references.threads, "0: all")
        ->capture_default_str();
    app.add_flag("--references-only", options.references_only, "Make them, and measure nothing");
    app.add_option("--longest-goal", options.longest_goal,
                   "Seconds that a run towards 1 % or 0.1 % may take")
        ->capture_default_str();
    app.add_flag("--tiny", options.tiny,
                 "A small scene, some seconds; exit code 1 when the methods do not agree");
    CLI11_PARSE(app, argc, argv);
    if (options.processor_time)
        rounds.clock = Clock::processor;
    if (options.tiny)
        make_tiny(options);
    try {
        return run(options);
    } catch (const Error& error) {
        std::fprintf(stderr, "efficiency: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
}
