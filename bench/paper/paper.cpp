#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

#include "paper/report.h"
#include "paper/runs.h"

// Runs the tables and figures of M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity
// (LSI-93-37-R, 1993), and sets ours beside theirs.

using namespace parallux;
using namespace parallux::paper;

namespace {

struct Options {
    std::string scenes = "scenes", json, figures;
    std::set<int> tables = {1, 2, 3, 4, 5, 6};
    int runs = 100;
    bool check = false;
};

std::set<int> parse_tables(const std::string& text) {
    std::set<int> tables;
    std::istringstream list(text);
    for (std::string item; std::getline(list, item, ',');) {
        if (item.size() != 1 || item[0] < '1' || item[0] > '6')
            throw Error(Fault::usage, "--tables " + text + ": expected numbers from 1 to 6");
        tables.insert(item[0] - '0');
    }
    return tables;
}

// The small form: every variant, few lines.
bool in_check(const Cell& cell) {
    return cell.lines <= 10'000 && !cell.doubtful && cell.patches <= 456;
}

Result run_cell(Rooms& rooms, const Cell& cell, const Options& options) {
    Result result;
    result.cell = cell;
    const bool counted = judged_by_counts(cell.table);
    const Errors& errors =
        rooms.errors(cell.scene, cell.variant, cell.lines, options.runs, counted);
    result.to_truth = spread_of(errors.truth);
    if (counted)
        result.to_counts = spread_of(errors.counted);
    result.errors = cell.table == 2 ? errors.counted : errors.truth;
    result.ours = spread_of(result.errors);
    result.predicted =
        rooms.predicted(cell.scene, cell.variant).quadratic(static_cast<double>(cell.lines));
    for (const Variant& bundles : bundle_variants(cell.variant))
        result.bundles.push_back(
            spread_of(rooms.errors(cell.scene, bundles, cell.lines, options.runs, false).truth));
    return result;
}

int run(const Options& options) {
    Rooms rooms(options.scenes);
    std::vector<Result> results;
    int table = 0;
    for (const Cell& cell : all_cells()) {
        if (!options.tables.contains(cell.table) || (options.check && !in_check(cell)))
            continue;
        if (cell.table != table)
            print_heading(table = cell.table);
        results.push_back(run_cell(rooms, cell, options));
        print_row(results.back());
    }
    const std::vector<Slope> slopes = slopes_of(rooms, results);
    const std::vector<Distribution> distributions = distributions_of(rooms, results);
    print_slopes(slopes);
    print_gains(results);
    print_distributions(distributions);
    std::vector<PictureRun> pictures;
    if (!options.figures.empty()) {
        write_histograms(options.figures, distributions);
        pictures = draw_pictures(options.scenes, options.figures);
        print_pictures(pictures);
    }
    if (!options.json.empty())
        write_json(options.json, results, slopes, distributions, pictures);
    if (!options.check)
        return 0;
    const int wrong = disagreements(results);
    std::printf("\n%zu cells, %d of them away from the paper\n", results.size(), wrong);
    return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"The tables and figures of A Global Algorithm for Linear Radiosity"};
    Options options;
    std::string tables;
    app.add_option("--runs", options.runs, "Of each cell")
        ->capture_default_str()
        ->check(CLI::Range(2, 1'000'000));
    app.add_option("--tables", tables, "Which ones: 1,3,6 [all]");
    app.add_option("--scenes", options.scenes, "Folder of the scenes")->capture_default_str();
    app.add_option("--json", options.json, "Where to write all cells");
    app.add_option("--figures", options.figures,
                   "Folder for histograms (figures 3, 4) and pictures (5, 6)");
    app.add_flag("--check", options.check,
                 "A small form: cells of few lines; exit code 1 where one is away from the paper");
    CLI11_PARSE(app, argc, argv);
    try {
        if (!tables.empty())
            options.tables = parse_tables(tables);
        return run(options);
    } catch (const Error& error) {
        std::fprintf(stderr, "paper: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
}
