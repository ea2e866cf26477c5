#include "paper/report.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <tuple>

#include <nlohmann/json.hpp>

#include "output/output_file.h"

namespace parallux::paper {

double Result::z() const {
    const double own = ours.standard_error(), theirs = ours.variation() * cell.paper / 10;
    const double digit = 1e-7 / std::sqrt(12.0);
    return (ours.mean - cell.paper) / std::sqrt(own * own + theirs * theirs + digit * digit);
}

int disagreements(const std::vector<Result>& results) {
    int count = 0;
    for (const Result& result : results)
        count += !result.cell.doubtful && std::fabs(result.z()) > 3.5;
    return count;
}

namespace {

struct Fit {
    std::vector<double> x, y;

    double slope() const {
        const double n = static_cast<double>(x.size());
        const double mx = std::accumulate(x.begin(), x.end(), 0.0) / n;
        const double my = std::accumulate(y.begin(), y.end(), 0.0) / n;
        double xx = 0, xy = 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            xx += (x[k] - mx) * (x[k] - mx);
            xy += (x[k] - mx) * (y[k] - my);
        }
        return xy / xx;
    }
};

std::string family(const Cell& cell) {
    return cell.table == 2 ? "scene 2" : cell.table == 5 ? "scene 3" : "scene 1";
}

}  // namespace

std::vector<Slope> slopes_of(const std::vector<Result>& results) {
    // Against lines for each scene, variant and number of patches; against patches at equal lines,
    // averaged over the numbers of lines.
    std::map<std::tuple<int, std::string, std::uint32_t>, Fit> by_lines;
    std::map<std::tuple<int, std::string, std::uint64_t>, Fit> by_patches;
    for (const Result& result : results) {
        const Cell& cell = result.cell;
        const double error = std::log(result.ours.mean);
        Fit& lines = by_lines[{cell.table, cell.variant.name, cell.patches}];
        lines.x.push_back(std::log(static_cast<double>(cell.lines)));
        lines.y.push_back(error);
        Fit& patches = by_patches[{cell.table, cell.variant.name, cell.lines}];
        patches.x.push_back(std::log(static_cast<double>(cell.patches)));
        patches.y.push_back(error);
    }
    std::vector<Slope> slopes;
    auto name = [&](int table) {
        for (const Result& result : results)
            if (result.cell.table == table)
                return "table " + std::to_string(table) + ", " + family(result.cell);
        return std::string();
    };
    for (const auto& [key, fit] : by_lines)
        if (fit.x.size() > 1)
            slopes.push_back(
                {std::get<1>(key),
                 name(std::get<0>(key)) + ", " + std::to_string(std::get<2>(key)) + " patches",
                 "lines", fit.slope(), static_cast<int>(fit.x.size())});
    for (const auto& [key, fit] : by_patches)
        if (fit.x.size() > 1)
            slopes.push_back(
                {std::get<1>(key),
                 name(std::get<0>(key)) + ", " + std::to_string(std::get<2>(key)) + " lines",
                 "patches", fit.slope(), static_cast<int>(fit.x.size())});
    return slopes;
}

std::vector<Distribution> distributions_of(Rooms& rooms, const std::vector<Result>& results) {
    std::vector<Distribution> distributions;
    for (const Result& result : results) {
        const Cell& cell = result.cell;
        const double stated = cell.patches == 6 ? (cell.lines == 10'000 ? 0.771 : 0.806)
                                                : (cell.lines == 100'000 ? 0.204 : 0.223);
        const bool wanted = cell.patches == 6 ? cell.lines >= 10'000 : cell.lines >= 100'000;
        if (cell.table != 6 || !wanted)
            continue;
        const Room& room = rooms.room(cell.scene);
        Distribution d;
        d.figure = cell.patches == 6 ? 3 : 4;
        d.patches = cell.patches;
        d.lines = cell.lines;
        d.errors = result.errors;
        d.mean = result.ours.mean;
        d.variation = result.ours.variation();
        d.paper_variation = stated;
        d.freedom = 2 / (d.variation * d.variation);
        d.p_value = kolmogorov_smirnov(d.errors, d.mean, d.freedom);
        d.theory_variation = room.theory_variation;
        d.theory_freedom = room.theory_freedom;
        d.theory_mean = room.theory_full / static_cast<double>(cell.lines);
        d.theory_p_value = kolmogorov_smirnov(d.errors, d.mean, d.theory_freedom);
        distributions.push_back(std::move(d));
    }
    return distributions;
}

void print_heading(int table) {
    std::printf("\nTable %d: %s. Quadratic error, times 1e-7.\n", table, caption(table));
    std::printf("%7s %9s %-26s %10s %10s %6s %6s %10s | %10s %10s\n", "patches", "lines", "variant",
                "paper", "ours", "ratio", "z", "predicted", "bundles", "bundles");
    std::printf("%7s %9s %-26s %10s %10s %6s %6s %10s | %10s %10s\n", "", "", "", "", "", "", "",
                "", "random", "lattice");
}

void print_row(const Result& r) {
    std::printf("%7u %9llu %-26s %10.0f %10.2f %6.3f %+6.2f %10.2f | %10.2f %10.2f%s\n",
                r.cell.patches, static_cast<unsigned long long>(r.cell.lines), r.cell.variant.name,
                r.cell.paper * 1e7, r.ours.mean * 1e7, r.ratio(), r.z(), r.predicted * 1e7,
                r.bundles[0].mean * 1e7, r.bundles[1].mean * 1e7,
                r.cell.doubtful ? "  * the paper's cell does not agree with its other tables" : "");
    std::fflush(stdout);
}

void print_slopes(const std::vector<Slope>& slopes) {
    if (!slopes.empty())
        std::printf("\nSlopes of the quadratic error (log-log)\n");
    for (const Slope& s : slopes)
        std::printf("%-42s %-26s against %-8s %+.3f (%d cells)\n", s.scene.c_str(),
                    s.variant.c_str(), s.against.c_str(), s.slope, s.points);
}

namespace {

// Mean ratio of two sets of cells at equal patches and lines.
void print_ratio(const char* what, const std::vector<Result>& results, int table_a,
                 const std::string& variant_a, int table_b, const std::string& variant_b) {
    for (std::uint32_t patches : {6u, 54u}) {
        double sum = 0;
        int count = 0;
        for (const Result& a : results)
            for (const Result& b : results)
                if (a.cell.table == table_a && b.cell.table == table_b &&
                    a.cell.variant.name == variant_a && b.cell.variant.name == variant_b &&
                    a.cell.patches == patches && b.cell.patches == patches &&
                    a.cell.lines == b.cell.lines) {
                    sum += a.ours.mean / b.ours.mean;
                    ++count;
                }
        if (count > 0)
            std::printf("%-58s %3u patches: %.3f (mean of %d numbers of lines)\n", what, patches,
                        sum / count, count);
    }
}

}  // namespace

void print_gains(const std::vector<Result>& results) {
    std::printf("\n");
    print_ratio("bidirectional over oriented, scene 1", results, 6, "bidirectional", 3, "oriented");
    print_ratio("no first shot over exact first shot, scene 1", results, 3, "oriented", 4,
                "oriented, first shot exact");
    print_ratio("no first shot over exact first shot, scene 3", results, 5, "oriented", 5,
                "oriented, first shot exact");
}

void print_distributions(const std::vector<Distribution>& distributions) {
    if (!distributions.empty())
        std::printf(
            "\nFigures 3 and 4: errors of the runs of table 6\n%7s %9s %10s %10s | %22s | "
            "%16s | %16s\n",
            "patches", "lines", "mean", "theory", "variation paper/ours/th", "chi2 df run/th",
            "KS p run/th");
    for (const Distribution& d : distributions)
        std::printf("%7u %9llu %10.3g %10.3g | %7.3f %7.3f %7.3f | %7.2f %7.2f | %7.3f %7.3f\n",
                    d.patches, static_cast<unsigned long long>(d.lines), d.mean, d.theory_mean,
                    d.paper_variation, d.variation, d.theory_variation, d.freedom, d.theory_freedom,
                    d.p_value, d.theory_p_value);
}

void print_pictures(const std::vector<PictureRun>& pictures) {
    std::printf("\nFigures 5 and 6: 12150 patches, ours / paper\n");
    for (const PictureRun& p : pictures)
        std::printf(
            "figure %d: %.0f M local rays, %.0f M lines: list %.4f / %.2f, non-empty %.4f / "
            "%.2f, lines a patch: walls %.1f / %.0f, large cube %.1f / %.0f, small cubes "
            "%.1f / %.0f\n",
            p.figure, static_cast<double>(p.local_rays) * 1e-6, static_cast<double>(p.lines) * 1e-6,
            p.list, p.printed[0], p.nonempty_list, p.printed[1], p.walls, p.printed[2],
            p.large_cube, p.printed[3], p.small_cubes, p.printed[4]);
}

void write_json(const std::string& file, const std::vector<Result>& results,
                const std::vector<Slope>& slopes, const std::vector<Distribution>& distributions,
                const std::vector<PictureRun>& pictures) {
    using Json = nlohmann::ordered_json;
    Json json{{"cells", Json::array()},
              {"slopes", Json::array()},
              {"distributions", Json::array()},
              {"pictures", Json::array()}};
    for (const Result& r : results) {
        json["cells"].push_back({{"table", r.cell.table},
                                 {"patches", r.cell.patches},
                                 {"lines", r.cell.lines},
                                 {"variant", r.cell.variant.name},
                                 {"paper", r.cell.paper},
                                 {"ours", r.ours.mean},
                                 {"ratio", r.ratio()},
                                 {"z", r.z()},
                                 {"predicted", r.predicted},
                                 {"runs", r.ours.count},
                                 {"variation", r.ours.variation()},
                                 {"doubtful", r.cell.doubtful}});
        const std::vector<Variant> variants = bundle_variants(r.cell.variant);
        for (std::size_t k = 0; k < variants.size(); ++k)
            json["cells"].push_back({{"table", r.cell.table},
                                     {"patches", r.cell.patches},
                                     {"lines", r.cell.lines},
                                     {"variant", variants[k].name},
                                     {"paper", nullptr},
                                     {"ours", r.bundles[k].mean},
                                     {"ratio", nullptr},
                                     {"z", nullptr},
                                     {"predicted", nullptr},
                                     {"runs", r.bundles[k].count},
                                     {"variation", r.bundles[k].variation()}});
    }
    for (const Slope& s : slopes)
        json["slopes"].push_back({{"scene", s.scene},
                                  {"variant", s.variant},
                                  {"against", s.against},
                                  {"slope", s.slope},
                                  {"cells", s.points}});
    for (const Distribution& d : distributions)
        json["distributions"].push_back({{"figure", d.figure},
                                         {"patches", d.patches},
                                         {"lines", d.lines},
                                         {"mean", d.mean},
                                         {"theory_mean", d.theory_mean},
                                         {"variation", d.variation},
                                         {"paper_variation", d.paper_variation},
                                         {"theory_variation", d.theory_variation},
                                         {"freedom", d.freedom},
                                         {"theory_freedom", d.theory_freedom},
                                         {"p_value", d.p_value},
                                         {"theory_p_value", d.theory_p_value}});
    for (const PictureRun& p : pictures)
        json["pictures"].push_back({{"figure", p.figure},
                                    {"local_rays", p.local_rays},
                                    {"lines", p.lines},
                                    {"average_list", p.list},
                                    {"average_nonempty_list", p.nonempty_list},
                                    {"lines_a_wall_patch", p.walls},
                                    {"lines_a_large_cube_patch", p.large_cube},
                                    {"lines_a_small_cube_patch", p.small_cubes},
                                    {"seconds", p.seconds}});
    OutputFile output(file);
    output.write(json.dump(2) + "\n");
    output.commit();
}

}  // namespace parallux::paper
