#include "cli/method_options.h"

#include "cli/option_group.h"
#include "cli/options.h"
#include "cli/values.h"

namespace parallux {

namespace {

constexpr std::uint64_t count_32 = 0xffffffffu;

Method parse_method(const std::string& value) {
    return parse_choice<Method>("--method", value,
                                {{"bundles", Method::bundles},
                                 {"lines", Method::lines},
                                 {"progressive", Method::progressive},
                                 {"particles", Method::particles},
                                 {"matrix", Method::matrix}});
}

FirstShot parse_first_shot(const std::string& value) {
    return parse_choice<FirstShot>(
        "--first-shot", value,
        {{"none", FirstShot::off}, {"rays", FirstShot::rays}, {"exact", FirstShot::exact}});
}

// Which method, and its local shots.
void add_kind(CLI::App& app, SolveSettings& s) {
    const OptionGroup option{app, "Method"};
    option(
        "--method", "M",
        "bundles (of parallel lines), lines (independent, one after the other), or for comparison "
        "progressive, particles, matrix [bundles]",
        [&](auto& v) { s.method = parse_method(v); });
    option("--direction", "D", "bidirectional or oriented exchange [bidirectional]", [&](auto& v) {
        s.direction = parse_choice<Direction>(
            "--direction", v,
            {{"bidirectional", Direction::bidirectional}, {"oriented", Direction::oriented}});
    });
    option(
        "--first-shot", "F",
        "Direct light by rays, exact (form factors; emitters × patches), or none [exact in scenes "
        "of few surfaces and sources, else rays]",
        [&](auto& v) { s.first_shot = parse_first_shot(v); });
    option("--first-shot-rays", "N",
           "Rays of the first shot; with --target-error of its first round, more in proportion in "
           "longer ones [grows with the lines]",
           [&](auto& v) { s.first_shot_rays = parse_count("--first-shot-rays", v, 1); });
    option("--shots", "N", "Then so many more, from the patches with most unshot power [0]",
           [&](auto& v) { s.shots = parse_count("--shots", v, 0); });
}

// How long a run is.
void add_length(CLI::App& app, SolveSettings& s) {
    const OptionGroup option{app, "Method"};
    auto* bundles = option("--bundles", "D", "Directions of parallel lines [4096]",
                           [&](auto& v) { s.bundles = parse_count("--bundles", v, 1); });
    auto* lines =
        option("--lines", "N", "Lines in all, rays or particles of the methods that send those",
               [&](auto& v) { s.lines = parse_count("--lines", v, 1); });
    lines->excludes(bundles);
    option(
        "--target-error", "R",
        "Run until the relative RMS is below this with 95 % confidence, as 0.01; exit with 1 when "
        "that is not reached",
        [&](auto& v) { s.target_error = parse_real("--target-error", v, 1e-6, 1); })
        ->excludes(bundles)
        ->excludes(lines);
}

// How lines are laid and dealt out.
void add_lines(CLI::App& app, SolveSettings& s) {
    const OptionGroup option{app, "Method"};
    auto* spacing = option("--line-spacing", "L", "Between a bundle's lines, in the scene's units",
                           [&](auto& v) { s.line_spacing = parse_positive("--line-spacing", v); });
    option(
        "--lines-per-patch", "C",
        "Lines of a bundle over a mean patch's area [4 with 1500 bundles a group, more with more]",
        [&](auto& v) { s.lines_per_patch = parse_positive("--lines-per-patch", v); })
        ->excludes(spacing);
    option("--gather-share", "S", "Of the bundles, that gather once the others have passed [0.7]",
           [&](auto& v) { s.gather_share = parse_real("--gather-share", v, 0, 1); });
    option(
        "--groups", "R",
        "Independent parts of the bundles, whose spread tells the error; 1: unknown [8 with 800 "
        "bundles or more]",
        [&](auto& v) { s.groups = static_cast<std::uint32_t>(parse_count("--groups", v, 1, 64)); });
    option("--directions", "D", "lattice or random [lattice]", [&](auto& v) {
        s.directions = parse_choice<DirectionSet>(
            "--directions", v,
            {{"lattice", DirectionSet::lattice}, {"random", DirectionSet::random}});
    });
    option(
        "--batch", "B",
        "Bundles, or as many lines, from one snapshot; part of the result [bundles up to 64, lines "
        "one by one]",
        [&](auto& v) {
            s.batch = static_cast<std::uint32_t>(parse_count("--batch", v, 1, count_32));
        });
    option("--sphere-radius", "R", "Of independent lines, in the scene's units [around the scene]",
           [&](auto& v) { s.sphere_radius = parse_positive("--sphere-radius", v); });
    option("--seed", "S", "Equal seeds give equal results, whatever the threads [1]",
           [&](auto& v) { s.seed = parse_count("--seed", v, 0); });
}

}  // namespace

void add_method(CLI::App& app, SolveSettings& s) {
    add_kind(app, s);
    add_length(app, s);
    add_lines(app, s);
}

}  // namespace parallux
