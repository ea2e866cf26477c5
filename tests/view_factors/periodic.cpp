#include <doctest/doctest.h>

#include <array>

#include "lines/periodic.h"
#include "parallux/error.h"
#include "parallux/solve.h"
#include "support/seeds.h"
#include "view_factors/scenes.h"

// View factors of scenes that repeat without end: closed forms, and the same from many tiles.
// Planted, seen to fail the first two: lines outside the period's cell let in; copies to the next
// tile alone.

using namespace parallux;
using namespace parallux::test;

namespace {

// Tiles of 1 x 1.25 with a block on each, the ground around it in eight pieces: 13 nodes a tile.
constexpr std::size_t own = 13;

Scene blocks(int copies) {
    Scene scene;
    const double lines[4] = {0, 0.3, 0.7, 1};
    for (int i = -copies; i <= copies; ++i)
        for (int j = -copies; j <= copies; ++j) {
            const glm::dvec3 at(i, 1.25 * j, 0);
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    add_plate(
                        scene,
                        at + glm::dvec3(lines[a], 1.25 * lines[b], a == 1 && b == 1 ? 0.6 : 0),
                        {lines[a + 1] - lines[a], 0, 0}, {0, 1.25 * (lines[b + 1] - lines[b]), 0},
                        "plate");
            const glm::dvec3 up(0, 0, 0.6), x(0.4, 0, 0), y(0, 0.5, 0);
            const glm::dvec3 low = at + glm::dvec3(0.3, 0.375, 0), high = low + x + y;
            add_plate(scene, low, x, up, "wall");
            add_plate(scene, low, up, y, "wall");
            add_plate(scene, high, -x, up, "wall");
            add_plate(scene, high, up, -y, "wall");
        }
    return scene;
}

// Factors of a tile's nodes to each of a tile's, all copies together, to the eight rings of
// Tregenza's sky, the ground and backs; over 16 seeds. `first`: the tile's own first node.
std::vector<Sample> rows(const Scene& scene, std::size_t first) {
    constexpr std::size_t runs = 16, columns = own + 10;
    constexpr std::uint32_t ring_end[8] = {30, 60, 84, 108, 126, 138, 144, 145};
    const Patches patches = one_each(scene);
    std::vector<std::vector<double>> all(runs, std::vector<double>(own * columns, 0));
    parallel_for(0, runs, 1, [&](std::size_t seed, std::size_t, unsigned) {
        FactorSettings settings;
        settings.bundles = 256;
        settings.groups = 1;
        settings.line_spacing = 0.05;
        settings.sky_parts = SkyParts::tregenza;
        settings.seed = seed + 1;
        settings.threads = 1;
        const Factors factors = view_factors(scene, patches, settings);
        for (std::size_t i = 0; i < own; ++i) {
            double* row = &all[seed][i * columns];
            const std::size_t node = first + i;
            for (std::uint64_t k = factors.start[node]; k < factors.start[node + 1]; ++k)
                row[factors.column[k] % own] += factors.exchange[k] / factors.nodes[node].area;
            const double* outside = &factors.outside[node * factors.outsides()];
            for (std::uint32_t part = 0; part < factors.sky_parts; ++part)
                row[own + static_cast<std::size_t>(std::upper_bound(ring_end, ring_end + 8, part) -
                                                   ring_end)] += outside[part];
            row[own + 8] = outside[factors.sky_parts];
            row[own + 9] = outside[factors.sky_parts + 1];
        }
    });
    std::vector<Sample> samples(own * columns);
    for (const std::vector<double>& run : all)
        for (std::size_t k = 0; k < run.size(); ++k)
            samples[k].add(run[k]);
    return samples;
}

}  // namespace

TEST_CASE("factors of an endless street meet Hottel's crossed strings") {
    constexpr int runs = 16;
    for (const double h : {0.5, 2.0}) {
        CAPTURE(h);
        Scene scene;
        add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, "floor");
        add_plate(scene, {0, 0, 0}, {0, 0.7, 0}, {0, 0, h}, "left");
        add_plate(scene, {1, 0, 0}, {0, 0, h}, {0, 0.7, 0}, "right");
        scene.period[0] = {0, 0.7, 0};
        FactorSettings settings;
        settings.bundles = 64;
        settings.groups = 1;
        const double slant = std::sqrt(1 + h * h), floor_wall = (1 + h - slant) / 2;
        const double exact[4] = {floor_wall, floor_wall, (slant - 1) / h, slant - h};
        std::array<Sample, 4> found;
        for (int run = 0; run < runs; ++run) {
            settings.seed = static_cast<std::uint64_t>(run) + 1;
            const Factors factors = view_factors(scene, one_each(scene), settings);
            found[0].add(factor(factors, 0, 1));
            found[1].add(factor(factors, 0, 2));
            found[2].add(factor(factors, 1, 2));
            found[3].add(outside(factors, 0, 0));
            CHECK(factor(factors, 0, 0) == 0);
            CHECK(check_factors(factors).row_deviation < 1e-12);
            CHECK(check_factors(factors).reciprocity == 0);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(std::fabs(found[k].z(exact[k])) < sidak_bound(8, runs));
            // Of some use: the copies next door alone would be off by more.
            CHECK(found[k].standard_error() < 0.003);
        }
    }
}

TEST_CASE("factors of a city that repeats are those of the middle of 15 x 15 of its tiles") {
    Scene tile = blocks(0);
    tile.period = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1.25, 0)};
    const std::vector<Sample> one = rows(tile, 0), many = rows(blocks(7), 112 * own);
    const double bound = sidak_bound(one.size(), 16);
    CHECK(worst_difference(one, many) < bound);
    // The control: the tile alone.
    tile.period = {glm::dvec3(0), glm::dvec3(0)};
    CHECK(worst_difference(rows(tile, 0), many) > bound);
}

TEST_CASE("periodic factors: equal bits on any number of threads, refusals, memory of copies") {
    Scene tile = blocks(0);
    const Patches patches = one_each(tile);
    CHECK(copies_bytes(tile) == 0);
    tile.period = {glm::dvec3(1, 0, 0), glm::dvec3(0.2, 1.25, 0)};
    FactorSettings settings;
    settings.bundles = 100;
    settings.threads = 1;
    const Factors once = view_factors(tile, patches, settings);
    for (unsigned threads : {2u, 7u}) {
        settings.threads = threads;
        const Factors again = view_factors(tile, patches, settings);
        CHECK(again.exchange == once.exchange);
        CHECK(again.outside == once.outside);
        CHECK(again.outside_error == once.outside_error);
    }
    settings.line_spacing = 1e-5;
    CHECK_THROWS_AS(view_factors(tile, patches, settings), Error);
}

// Planted, seen: without the quarter for directions in between; copies in neither forecast.
TEST_CASE("no bundle has more copies than the forecast of memory counts") {
    for (const double height : {1.0, 5.0}) {
        Scene tile = blocks(0);
        for (glm::dvec3& position : tile.positions)
            position.z *= height;
        tile.period = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1.25, 0)};
        const Patches patches = one_each(tile);
        BundleSettings lattice;
        lattice.count = 2000;
        lattice.spacing = 0.2;
        std::size_t most = 0;
        for (std::uint64_t k = 0; k < lattice.count; ++k)
            most = std::max(
                most, PeriodicBundle(tile, patches, make_bundle(lattice, k)).copied_surfaces());
        const std::uint64_t counted = most_copied_surfaces(tile);
        CHECK(most <= counted);
        CHECK(most > counted / 2);
        // Both forecasts have them.
        Scene alone = tile;
        alone.period = {};
        SolveSettings run;
        run.threads = 2;
        CHECK(predicted_memory(tile, patches, run) >=
              predicted_memory(alone, patches, run) + 2 * copies_bytes(tile));
        FactorSettings factors;
        factors.threads = 2;
        factors.bundles = 1;
        const std::uint64_t need = view_factors(alone, patches, factors).predicted_memory;
        CHECK(view_factors(tile, patches, factors).predicted_memory >=
              need + copies_bytes(tile) / 2);
        // Every tile adds the copies of its own surfaces.
        Scene twice = tile;
        twice.surfaces.insert(twice.surfaces.end(), tile.surfaces.begin(), tile.surfaces.end());
        CHECK(most_copied_surfaces(twice) == 2 * counted);
    }
}
