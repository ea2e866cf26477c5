#include "efficiency/report.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "efficiency/gains.h"
#include "efficiency/judge.h"
#include "output/output_file.h"

namespace parallux::efficiency {

namespace {

std::vector<std::string> methods_in(const std::vector<Row>& rows) {
    std::vector<std::string> names;
    for (const Row& row : rows)
        if (names.empty() || names.back() != row.method)
            names.push_back(row.method);
    return names;
}

void print_method(const std::vector<const Row*>& curve) {
    const Row* best = curve.front();
    for (const Row* row : curve)
        if (row->gain > best->gain)
            best = row;
    std::printf("%-18s %9llu %9.2f %8.3f %9.3f ", best->method.c_str(),
                static_cast<unsigned long long>(best->length), best->lines * 1e-6, best->seconds,
                100 * best->relative_rms);
    for (const Row* row : curve)
        std::printf(" %8.3g", row->gain);
    if (curve.size() > 1)
        std::printf("  %6.2f", fit(
                                   curve, [](const Row& row) { return row.lines; },
                                   [](const Row& row) { return row.quadratic_error; })
                                   .slope);
    const Row& last = *curve.back();
    std::printf(" %9.3f %8.3f%s\n", 100 * last.relative_rms, 100 * bias_of(last),
                is_off(last) ? " *" : "");
}

void warn_of_reference(const std::vector<Row>& rows) {
    for (const Row& row : rows)
        if (row.reference_share > 0.1)
            std::printf(
                "warning: %s at %.3f s: %.0f %% of its quadratic error may be the "
                "reference's\n",
                row.method.c_str(), row.seconds, 100 * row.reference_share);
}

}  // namespace

void print_rows(const std::vector<Row>& rows, int seeds, Clock clock) {
    const std::size_t lengths = rows_of(rows, rows.front().method).size();
    std::printf("%s, %u thread%s, %d runs a row, %s time; best length, gains of all lengths\n",
                rows.front().scene.c_str(), rows.back().threads, rows.back().threads > 1 ? "s" : "",
                seeds, clock == Clock::wall ? "wall" : "processor");
    std::printf("%-18s %9s %9s %8s %9s  %*s  %6s %9s %8s\n", "method", "length", "Mlines",
                "seconds", "rms %", static_cast<int>(9 * lengths - 1), "gains, shortest first",
                "slope", "longest %", "bias %");
    for (const std::string& method : methods_in(rows))
        print_method(rows_of(rows, method));
    std::printf("bias: of the longest runs' mean, beyond chance; * with 99.9 %% confidence\n");
    warn_of_reference(rows);
    std::fflush(stdout);
}

void print_goals(const std::vector<Goal>& goals) {
    for (const Goal& goal : goals)
        std::printf(
            "%s to %.3g %%: %.3f s, %.0f bundles%s%.4f %%%s\n", goal.method.c_str(),
            100 * goal.wanted, goal.seconds, goal.length,
            goal.tried ? "; reached " : ", foretold and not tried: ", 100 * goal.relative_rms,
            goal.reference_share > 0.1 ? ", in part the reference's own error" : "");
    std::fflush(stdout);
}

void write_json(const std::string& file, const std::vector<Row>& rows,
                const std::vector<Goal>& goals, Clock clock) {
    using Json = nlohmann::ordered_json;
    Json json{{"rows", Json::array()},
              {"goals", Json::array()},
              {"clock", clock == Clock::wall ? "wall" : "processor"}};
    for (const Row& row : rows)
        json["rows"].push_back({{"scene", row.scene},
                                {"method", row.method},
                                {"threads", row.threads},
                                {"seconds", row.seconds},
                                {"lines", row.lines},
                                {"quadratic_error", row.quadratic_error},
                                {"relative_rms", row.relative_rms},
                                {"gain", row.gain},
                                {"length", row.length},
                                {"first_shot_rays", row.first_shot_rays},
                                {"runs", row.errors.size()},
                                {"wall_seconds", median(row.wall)},
                                {"processor_seconds", median(row.cpu)},
                                {"mean_error", row.mean_error},
                                {"mean_expected", row.mean_expected},
                                {"mean_bound", row.mean_bound},
                                {"bias", bias_of(row)},
                                {"reference_share", row.reference_share}});
    for (const Goal& goal : goals)
        json["goals"].push_back({{"scene", goal.scene},
                                 {"method", goal.method},
                                 {"wanted", goal.wanted},
                                 {"seconds", goal.seconds},
                                 {"bundles", goal.length},
                                 {"relative_rms", goal.relative_rms},
                                 {"tried", goal.tried},
                                 {"reference_share", goal.reference_share}});
    OutputFile output(file);
    output.write(json.dump(2) + "\n");
    output.commit();
}

void write_curves(const std::string& folder, const std::vector<Row>& rows) {
    std::string text;
    for (const std::string& method : methods_in(rows)) {
        text += (text.empty() ? "\"" : "\n\n\"") + method + "\"\n";
        for (const Row* row : rows_of(rows, method)) {
            char line[96];
            std::snprintf(line, sizeof line, "%.6g %.6g %.6g\n", row->seconds, row->relative_rms,
                          row->lines);
            text += line;
        }
    }
    const std::string scene = std::filesystem::path(rows.front().scene).filename().string();
    OutputFile output(std::filesystem::path(folder) / (scene + ".dat"));
    output.write(text);
    output.commit();
}

}  // namespace parallux::efficiency
