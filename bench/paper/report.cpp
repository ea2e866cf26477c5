#include "paper/report.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <tuple>

#include <nlohmann/json.hpp>

#include "output/output_file.h"

namespace parallux::paper {

double Result::z_of(const Spread& spread) const {
    const double own = spread.standard_error(), theirs = spread.variation() * cell.paper / 10;
    const double digit = 1e-7 / std::sqrt(12.0);
    return (spread.mean - cell.paper) / std::sqrt(own * own + theirs * theirs + digit * digit);
}

int disagreements(const std::vector<Result>& results) {
    int count = 0;
    for (const Result& result : results)
        if (result.cell.table == 2)
            count += std::fabs(result.ratio() - 1) > 0.15;
        else
            count += result.cell.paper > 0 && !result.cell.doubtful && std::fabs(result.z()) > 3.5;
    return count;
}

namespace {

std::string family(const Cell& cell) {
    return cell.table == 2 ? "scene 2" : cell.table == 5 ? "scene 3" : "scene 1";
}

// Points in groups, each group with a level of its own.
struct Fit {
    struct Point {
        double x, y, weight;
    };
    std::map<std::uint64_t, std::vector<Point>> groups;

    void add(std::uint64_t group, double x, const Spread& spread) {
        // log of the mean has the relative standard error of the mean.
        const double error = spread.standard_error() / spread.mean;
        groups[group].push_back({std::log(x), std::log(spread.mean), 1 / (error * error)});
    }

    Slope slope() const {
        Slope result;
        double xx = 0, xy = 0;
        for (const auto& [group, points] : groups) {
            double weight = 0, mean_x = 0, mean_y = 0;
            for (const Point& p : points) {
                weight += p.weight;
                mean_x += p.weight * p.x;
                mean_y += p.weight * p.y;
            }
            mean_x /= weight;
            mean_y /= weight;
            for (const Point& p : points) {
                xx += p.weight * (p.x - mean_x) * (p.x - mean_x);
                xy += p.weight * (p.x - mean_x) * (p.y - mean_y);
            }
            result.cells += points.size() > 1 ? static_cast<int>(points.size()) : 0;
        }
        result.slope = xx > 0 ? xy / xx : 0;
        result.error = xx > 0 ? 1 / std::sqrt(xx) : 0;
        return result;
    }
};

double exits_a_patch(Rooms& rooms, const Cell& cell) {
    const Room& room = rooms.room(cell.scene);
    const double area = std::accumulate(room.patches.area.begin(), room.patches.area.end(), 0.0);
    const double radius = line_sphere(room.scene).radius;
    const double exits =
        static_cast<double>(cell.lines) * area / cell.patches / (2 * pi * radius * radius);
    return cell.variant.direction == Direction::oriented ? exits / 2 : exits;
}

}  // namespace

std::vector<Slope> slopes_of(Rooms& rooms, const std::vector<Result>& results) {
    std::map<std::pair<std::string, std::string>, std::pair<Fit, Fit>> fits;
    for (const Result& result : results) {
        const Cell& cell = result.cell;
        // Table 3 shows the runs of table 1 again.
        if (cell.table == 3 || exits_a_patch(rooms, cell) < 20)
            continue;
        const double lines = static_cast<double>(cell.lines), patches = cell.patches;
        auto add = [&](const std::string& name, const Spread& spread) {
            auto& [by_lines, by_patches] = fits[{family(cell), name}];
            by_lines.add(cell.patches, lines, spread);
            if (cell.patches > 6)
                by_patches.add(cell.lines, patches, spread);
        };
        const std::string name = cell.variant.name;
        add(name, result.to_truth);
        if (cell.table == 2)
            add(name + ", to counts", result.to_counts);
        const std::string shot =
            cell.variant.first_shot == FirstShot::exact ? ", first shot exact" : "";
        // Table 6 shows the bundles of table 1 again.
        if (cell.table != 6 || cell.paper == 0) {
            add("bundles, random" + shot, result.bundles[0]);
            add("bundles, lattice" + shot, result.bundles[1]);
        }
    }
    std::vector<Slope> slopes;
    for (const auto& [key, fit] : fits)
        for (bool against_lines : {true, false}) {
            Slope slope = (against_lines ? fit.first : fit.second).slope();
            slope.scene = key.first;
            slope.variant = key.second;
            slope.against = against_lines ? "lines" : "patches";
            if (slope.cells > 1)
                slopes.push_back(slope);
        }
    return slopes;
}

std::vector<Distribution> distributions_of(Rooms& rooms, const std::vector<Result>& results) {
    std::vector<Distribution> distributions;
    for (const Result& result : results) {
        const Cell& cell = result.cell;
        const double stated = cell.patches == 6 ? (cell.lines == 10'000 ? 0.771 : 0.806)
                                                : (cell.lines == 100'000 ? 0.204 : 0.223);
        const bool wanted = cell.patches == 6 ? cell.lines >= 10'000 : cell.lines >= 100'000;
        if (cell.table != 6 || !wanted || cell.paper == 0)
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
    std::printf("%7s %9s %-26s %8s %10s %6s %6s | %10s %10s %10s | %10s %10s\n", "patches", "lines",
                "variant", "paper", "ours", "ratio", "z", "to exact", "predicted", "to counts",
                "bundles,", "bundles,");
    std::printf("%7s %9s %-26s %8s %10s %6s %6s | %10s %10s %10s | %10s %10s\n", "", "", "", "", "",
                "", "", "", "", "", "random", "lattice");
}

void print_row(const Result& r) {
    std::printf("%7u %9llu %-26s ", r.cell.patches, static_cast<unsigned long long>(r.cell.lines),
                r.cell.variant.name);
    if (r.cell.paper > 0)
        std::printf("%8.0f %10.2f %6.3f %+6.2f", r.cell.paper * 1e7, r.ours.mean * 1e7, r.ratio(),
                    r.z());
    else
        std::printf("%8s %10.2f %6s %6s", "-", r.ours.mean * 1e7, "", "");
    std::printf(" | %10.2f %10.2f ", r.to_truth.mean * 1e7, r.predicted * 1e7);
    if (r.to_counts.count > 0)
        std::printf("%10.2f", r.to_counts.mean * 1e7);
    else
        std::printf("%10s", "");
    std::printf(" | %10.2f %10.2f%s\n", r.bundles[0].mean * 1e7, r.bundles[1].mean * 1e7,
                r.cell.doubtful ? "  * the paper's cell does not agree with its other tables" : "");
    std::fflush(stdout);
}

void print_slopes(const std::vector<Slope>& slopes) {
    if (!slopes.empty())
        std::printf(
            "\nSlopes of the quadratic error (log-log), cells of 20 exits a patch and more\n");
    for (const Slope& s : slopes)
        std::printf("%-8s %-38s against %-8s %+.3f +- %.3f (%d cells)\n", s.scene.c_str(),
                    s.variant.c_str(), s.against.c_str(), s.slope, s.error, s.cells);
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
        auto add = [&](const std::string& variant, const char* reference, const Spread& spread,
                       bool beside_paper, bool predicted) {
            json["cells"].push_back(
                {{"table", r.cell.table},
                 {"patches", r.cell.patches},
                 {"lines", r.cell.lines},
                 {"variant", variant},
                 {"paper", beside_paper ? Json(r.cell.paper) : Json()},
                 {"ours", spread.mean},
                 {"ratio", beside_paper ? Json(spread.mean / r.cell.paper) : Json()},
                 {"z", beside_paper ? Json(r.z_of(spread)) : Json()},
                 {"predicted", predicted ? Json(r.predicted) : Json()},
                 {"reference", reference},
                 {"runs", spread.count},
                 {"variation", spread.variation()},
                 {"doubtful", r.cell.doubtful}});
        };
        // The reading of the reference that the table agrees with stands beside the paper's value.
        const std::string name = r.cell.variant.name;
        const char *truth = "exact solution", *counts = "[Sbert93] on the same lines";
        const bool by_counts = r.cell.table == 2, in_paper = r.cell.paper > 0;
        if (r.to_counts.count > 0)
            add(by_counts ? name : name + ", against [Sbert93] on the same lines", counts,
                r.to_counts, by_counts, false);
        add(by_counts ? name + ", against the exact solution" : name, truth, r.to_truth,
            in_paper && !by_counts, true);
        const std::vector<Variant> variants = bundle_variants(r.cell.variant);
        for (std::size_t k = 0; k < variants.size(); ++k)
            add(variants[k].name, truth, r.bundles[k], false, false);
    }
    for (const Slope& s : slopes)
        json["slopes"].push_back({{"scene", s.scene},
                                  {"variant", s.variant},
                                  {"against", s.against},
                                  {"slope", s.slope},
                                  {"standard_error", s.error},
                                  {"cells", s.cells}});
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
