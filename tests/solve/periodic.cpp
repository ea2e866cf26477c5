#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

#include "lines/periodic.h"
#include "parallux/error.h"
#include "parallux/solve.h"
#include "support/hand_made.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Scene bare(double reflectance) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(reflectance)};
    scene.objects = {"tile"};
    scene.sky.kind = Sky::Kind::uniform;
    scene.sky.zenith = Spectrum::constant(1);
    return scene;
}

// A stretch of street of width 1 between walls of this height; with `roofs`, they stand on blocks
// of half the width.
Scene canyon(double height, bool roofs) {
    Scene scene = bare(0);
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 0.7, 0});
    add_quad(scene, {0, 0, 0}, {0, 0.7, 0}, {0, 0, height});
    add_quad(scene, {1, 0, 0}, {0, 0, height}, {0, 0.7, 0});
    scene.period[0] = {0, 0.7, 0};
    if (roofs) {
        add_quad(scene, {1, 0, height}, {0.5, 0, 0}, {0, 0.7, 0});
        scene.period[1] = {1.5, 0, 0};
    }
    return scene;
}

// A tile with a block on it, for a city of them; the ground around the block in eight pieces.
Scene block_tile(double reflectance, double height, int copies) {
    Scene scene = bare(reflectance);
    const double lines[4] = {0, 0.3, 0.7, 1};
    for (int i = -copies; i <= copies; ++i)
        for (int j = -copies; j <= copies; ++j) {
            const glm::dvec3 at(i, 1.25 * j, 0);
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    add_quad(
                        scene,
                        at + glm::dvec3(lines[a], 1.25 * lines[b], a == 1 && b == 1 ? height : 0),
                        {lines[a + 1] - lines[a], 0, 0}, {0, 1.25 * (lines[b + 1] - lines[b]), 0});
            const glm::dvec3 up(0, 0, height), x(0.4, 0, 0), y(0, 0.5, 0);
            const glm::dvec3 low = at + glm::dvec3(0.3, 0.375, 0), high = low + x + y;
            add_quad(scene, low, x, up);
            add_quad(scene, low, up, y);
            add_quad(scene, high, -x, up);
            add_quad(scene, high, up, -y);
        }
    return scene;
}

// Irradiances over π of each patch over 32 seeds.
std::vector<Sample> shares(const Scene& scene, std::uint64_t bundles, double spacing) {
    const Patches patches = make_patches(scene);
    std::vector<std::vector<float>> all(32);
    parallel_for(0, all.size(), 1, [&](std::size_t begin, std::size_t, unsigned) {
        SolveSettings settings;
        settings.bundles = bundles;
        settings.groups = 1;
        settings.line_spacing = spacing;
        settings.threads = 1;
        settings.seed = begin + 1;
        const Solution solution = solve(scene, patches, settings);
        if (solution.energy.residual[0] == 0)
            all[begin] = solution.irradiance;
    });
    std::vector<Sample> samples(patches.count());
    for (const std::vector<float>& run : all) {
        REQUIRE(run.size() == samples.size());
        for (std::size_t k = 0; k < run.size(); ++k)
            samples[k].add(run[k] / pi);
    }
    return samples;
}

}  // namespace

TEST_CASE("an endless street meets Hottel's crossed strings") {
    // Floor to sky √(1 + h²) - h, wall to sky (1 + h - √(1 + h²)) / 2h, whether it is one street or
    // one of endlessly many between flat roofs. Planted, seen: lines outside the period's cell let
    // in; copies to the next tile alone. The control: the piece that is given, alone.
    for (double h : {0.5, 1.0, 3.0})
        for (bool roofs : {false, true}) {
            CAPTURE(h);
            CAPTURE(roofs);
            Scene scene = canyon(h, roofs);
            const double slant = std::sqrt(1 + h * h);
            const double truth[4] = {slant - h, (1 + h - slant) / (2 * h),
                                     (1 + h - slant) / (2 * h), 1};
            std::vector<Sample> samples = shares(scene, 512, 0.1);
            const double bound = sidak_bound(21, 32);
            for (std::size_t k = 0; k < samples.size(); ++k) {
                CAPTURE(k);
                CAPTURE(samples[k].mean());
                CAPTURE(truth[k]);
                CHECK(std::fabs(samples[k].z(truth[k])) < bound);
                CHECK(samples[k].standard_error() < 0.01);
            }
            scene.period = {glm::dvec3(0), glm::dvec3(0)};
            samples = shares(scene, 512, 0.1);
            CHECK(std::fabs(samples[0].z(truth[0])) > bound);
        }
}

TEST_CASE("a furnace that repeats stays a furnace") {
    // Sky and surfaces of one radiance: B = π all over, whatever the shape. Fails with the same.
    for (double reflectance : {0.2, 0.8}) {
        Scene scene = block_tile(reflectance, 0.8, 0);
        scene.period = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1.25, 0)};
        const double emission = pi * (1 - static_cast<double>(static_cast<float>(reflectance)));
        scene.materials[0].emission = Spectrum::constant(static_cast<float>(emission));
        const std::vector<Sample> samples = shares(scene, 512, 0.1);
        const double bound = sidak_bound(2 * samples.size(), 32);
        for (const Sample& sample : samples)
            CHECK(std::fabs(sample.z(1)) < bound);
    }
}

TEST_CASE("a city that repeats is as the middle of 15 x 15 of its tiles") {
    const Scene tiling = block_tile(0.5, 0.6, 7);
    Scene tile = block_tile(0.5, 0.6, 0);
    tile.period = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1.25, 0)};
    const std::vector<Sample> one = shares(tile, 1024, 0.1), many = shares(tiling, 1024, 0.1);
    const std::size_t own = one.size(), first = 112 * own;
    REQUIRE(many.size() == 225 * own);
    const std::vector<Sample> middle(many.begin() + first, many.begin() + first + own);
    const double bound = sidak_bound(own, 32);
    CHECK(worst_difference(one, middle) < bound);
    // Planted, seen: copies to the next tile alone. The control: the tile alone.
    tile.period = {glm::dvec3(0), glm::dvec3(0)};
    CHECK(worst_difference(shares(tile, 1024, 0.1), middle) > bound);
}

TEST_CASE("a low sun is hidden by the copies of a fence") {
    // A fence of height 1 every 10 m throws a shadow of 15 m. Planted, seen: no copies looked at.
    Scene scene = bare(0.3);
    scene.sky = {};
    for (int k = 0; k < 4; ++k)
        add_quad(scene, {2.5 * k, 0, 0}, {2.5, 0, 0}, {0, 1, 0});
    add_quad(scene, {5, 0, 0}, {0, 1, 0}, {0, 0, 1});
    scene.materials[0].two_sided = true;
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = -glm::normalize(glm::dvec3(15, 0, 1));
    sun.intensity = Spectrum::constant(100);
    sun.half_angle = sun_half_angle;
    scene.lights = {sun};
    SolveSettings settings;
    settings.bundles = 8;
    auto ground = [&] {
        const Patches patches = make_patches(scene);
        const std::vector<float> irradiance = solve(scene, patches, settings).irradiance;
        double most = 0;
        for (std::uint32_t k = 0; k < 4; ++k)
            most = std::max<double>(most, irradiance[patches.grids[k].front]);
        return most;
    };
    settings.gather_share = 0;
    CHECK(ground() > 6);  // beyond the fence, alone
    scene.period[0] = {10, 0, 0};
    scene.period[1] = {0, 1, 0};
    // Only what the fence reflects.
    CHECK(ground() < 3);
}

TEST_CASE(
    "a periodic scene gives equal bits on any number of threads, and refuses what it cannot") {
    Scene tile = block_tile(0.5, 0.6, 0);
    tile.period = {glm::dvec3(1, 0, 0), glm::dvec3(0.2, 1.25, 0)};
    const Patches patches = make_patches(tile);
    SolveSettings settings;
    settings.bundles = 200;
    std::uint64_t hash = 0;
    for (unsigned threads : {1u, 2u, 7u}) {
        settings.threads = threads;
        const Solution solution = solve(tile, patches, settings);
        CHECK(solution.energy.residual[0] == 0);
        if (threads == 1)
            hash = solution.hash;
        CHECK(solution.hash == hash);
    }
    // Tiles of this height are all but free of tilted directions; towers are not.
    CHECK(tilt_warning(tile) == "");
    CHECK(tilt_warning(block_tile(0.5, 0.6, 0)) == "");
    Scene towers = block_tile(0.5, 4, 0);
    towers.period = tile.period;
    CHECK(tilt_warning(towers).substr(0, 5) == "6.2 %");
    settings.method = Method::lines;
    CHECK_THROWS_AS(solve(tile, patches, settings), Error);
    settings.method = Method::bundles;
    settings.first_shot = FirstShot::rays;
    CHECK_THROWS_AS(solve(tile, patches, settings), Error);
    settings.first_shot = FirstShot::automatic;
    settings.line_spacing = 1e-4;
    CHECK_THROWS_AS(solve(tile, patches, settings), Error);
}
