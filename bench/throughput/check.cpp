#include "throughput/check.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "throughput/embree_lines.h"
#include "throughput/embree_packets.h"

// Tried, each alone, and found by this check: a packet's lines beside those of the bundle, hits of
// a line cut off after the third or (in packets) after the first, lines that end in the middle of
// the scene or are denser there, sides taken for each other, u for v, a triangle's inverted cells
// for upright ones, lines beyond a tile's edge, a wall of the room turned round.

namespace parallux::throughput {

namespace {

bool says(bool good, const char* what, double found, double allowed) {
    std::printf("  %-58s %12.3g  allowed %9.3g  %s\n", what, found, allowed, good ? "ok" : "WRONG");
    return good;
}

// Share of the exits that two runs of the same lines count at different patches.
double moved(const Measured& a, const Measured& b) {
    double difference = 0, all = 0;
    for (std::size_t patch = 0; patch < a.exits.size(); ++patch) {
        difference +=
            std::fabs(static_cast<double>(a.exits[patch]) - static_cast<double>(b.exits[patch]));
        all += static_cast<double>(a.exits[patch]);
    }
    return difference / all;
}

// How many standard errors the hits a line are from 2 A / (4 π R²), what isotropic lines through a
// sphere about surfaces of area A meet; the error from the spread of twenty parts of the lines.
double deviations(const Case& of, const EmbreeLines& engine) {
    double area = 0;
    for (const Surface& surface : of.scene.surfaces)
        area += surface_area(of.scene, surface);
    const double radius = line_sphere(of.scene).radius;
    const double expected = 2 * area / (4 * pi * radius * radius);
    constexpr int parts = 20;
    double sum = 0, squares = 0;
    for (int k = 0; k < parts; ++k) {
        constexpr std::uint64_t lines = 10'000;
        const Measured part = engine.trace(1, static_cast<std::uint64_t>(k) * lines, lines);
        const double hits = static_cast<double>(part.counts.hits) / lines;
        sum += hits;
        squares += hits * hits;
    }
    const double mean = sum / parts;
    const double error = std::sqrt((squares / parts - mean * mean) / (parts - 1));
    return (mean - expected) / error;
}

double hits_a_line(const Measured& run) {
    return static_cast<double>(run.counts.hits) / static_cast<double>(run.counts.lines);
}

// Share of the hits that have no partner across the air: none in a closed room of one-sided
// surfaces, but that Embree now and then misses one at an edge.
double unpaired(const Measured& run) {
    return 1 - 2 * static_cast<double>(run.counts.transfers) / static_cast<double>(run.counts.hits);
}

}  // namespace

bool engines_agree(const Case& of) {
    std::printf("%s: %zu patches\n", of.name.c_str(), of.patches.count());
    EmbreeLines patches(of, Parts::patches, true), parents(of, Parts::parents, true);
    EmbreePackets packets(of, true);
    const Measured a = patches.run(1), b = parents.run(2), c = packets.run(2);
    const Measured bundle = BundleEngine(of).run(1);
    bool good = true;
    good &= says(is_closed(of.scene), "the scene is closed", is_closed(of.scene), 1);
    const auto odd = static_cast<double>(bundle.counts.odd);
    good &= says(odd == 0, "lists of odd length, bundles", odd, 0);
    good &= says(unpaired(bundle) == 0, "hits without a partner, bundles", unpaired(bundle), 0);
    for (const auto& [what, run] : {std::pair{"hits without a partner, (a)", &a},
                                    std::pair{"hits without a partner, (b)", &b},
                                    std::pair{"hits without a partner, (c)", &c}})
        good &= says(std::fabs(unpaired(*run)) < 1e-4, what, unpaired(*run), 1e-4);
    const double z_a = deviations(of, patches), z_b = deviations(of, parents);
    good &= says(std::fabs(z_a) < 5, "(a) hits a line, standard errors from expected", z_a, 5);
    good &= says(std::fabs(z_b) < 5, "(b) hits a line, standard errors from expected", z_b, 5);
    const double m = moved(a, b);
    good &= says(m < 0.01, "exits at other patches, (a) against (b)", m, 0.01);
    const double lines =
        static_cast<double>(c.counts.lines) - static_cast<double>(bundle.counts.lines);
    good &= says(lines == 0, "lines, (c) less bundles", lines, 0);
    const double hits = hits_a_line(c) / hits_a_line(bundle) - 1;
    good &= says(std::fabs(hits) < 1e-4, "hits a line, (c) over bundles, less 1", hits, 1e-4);
    const double n = moved(bundle, c);
    good &= says(n < 0.01, "exits at other patches, (c) against bundles", n, 0.01);
    return good;
}

}  // namespace parallux::throughput
