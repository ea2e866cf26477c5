#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "parallux/solve.h"
#include "support/hand_made.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// A lamp at one end of a slot that is far longer than high: several lines of a bundle meet a patch,
// and where they lead depends strongly on the slope.
Scene slot() {
    Material wall = grey(0.8), lamp = grey(0.8, 1);
    Scene scene =
        room({lamp, wall, wall, wall, wall, wall}, 2, glm::dvec3(0), glm::dvec3(4, 1, 0.25));
    return scene;
}

Scene cube_in_cube() {
    Material wall = grey(0.5), lamp = grey(0.5, 1);
    Scene scene = room({lamp, wall, wall, wall, wall, wall}, 3);
    add_turned_cube(scene, {0.45, 0.5, 0.4}, 0.35, 2, grey(0.3));
    return scene;
}

// Radiosity by the rule of single lines applied to bundles: the first line that leaves a patch
// takes all its unshot energy. What a bundle's state would give without the linear share.
std::vector<double> first_line_takes_everything(const Scene& scene, const Patches& patches,
                                                std::uint64_t seed, std::uint64_t bundles,
                                                double spacing) {
    Projector projector(scene, patches);
    auto workspace = projector.make_workspace();
    Projection projection;
    IntersectionLists lists;
    std::vector<double> unshot(patches.count(), 0), received(patches.count(), 0);
    auto send = [&](std::uint32_t i, std::uint32_t j, double& from) {
        double energy = from + 2 * spacing * spacing * patches.emission[i] / double(bundles);
        received[j] += energy;
        return patches.reflectance[j] * energy;
    };
    for (std::uint64_t b = 0; b < bundles; ++b) {
        projector.project(make_bundle({seed, bundles, DirectionSet::random, spacing}, b),
                          projection);
        for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
            projector.lists(projection, tile, *workspace, lists);
            for (std::size_t line = 0; line < lists.lines(); ++line)
                for (std::uint32_t k = lists.start[line]; k + 1 < lists.start[line + 1]; ++k) {
                    std::uint32_t i = lists.hits[k].away, j = lists.hits[k + 1].toward;
                    if (i == none || j == none)
                        continue;
                    double to_j = send(i, j, unshot[i]), to_i = send(j, i, unshot[j]);
                    unshot[i] = to_i;
                    unshot[j] = to_j;
                }
        }
    }
    for (std::size_t k = 0; k < received.size(); ++k)
        received[k] = patches.emission[k] + patches.reflectance[k] * received[k] / patches.area[k];
    return received;
}

}  // namespace

TEST_CASE("bundles and independent lines agree on every patch") {
    // Welch's z over 32 seeds each. Fails when a bundle's facing is wrong (planted: front and back
    // exchanged in the projector), or its frame is not square to the direction.
    for (const Scene& scene : {cube_in_cube(), l_room(grey(0.7), grey(0.7, 1), 3), slot()}) {
        Patches patches = make_patches(scene);
        SolveSettings settings;
        settings.bundles = 1024;
        std::vector<Sample> bundles = over_seeds(scene, patches, settings, 32);
        settings.directions = DirectionSet::random;
        settings.first_shot = FirstShot::off;
        std::vector<Sample> random = over_seeds(scene, patches, settings, 32, 1000);
        settings.method = Method::lines;
        settings.batch = 16;
        settings.lines_per_patch = 1;
        settings.bundles = 1024;
        std::vector<Sample> lines = over_seeds(scene, patches, settings, 32, 2000);
        settings.direction = Direction::oriented;
        std::vector<Sample> oriented = over_seeds(scene, patches, settings, 32, 3000);
        double bound = sidak_bound(4 * patches.count(), 32);
        CHECK(worst_difference(bundles, lines) < bound);
        CHECK(worst_difference(bundles, random) < bound);
        CHECK(worst_difference(random, lines) < bound);
        CHECK(worst_difference(bundles, oriented) < bound);
    }
}

TEST_CASE("the rule that the first line takes everything is wrong by more than 5 %, ours is not") {
    Scene scene = slot();
    Patches patches = make_patches(scene);
    // 16 lines a patch of mean area.
    double area = 0;
    for (double a : patches.area)
        area += a;
    double spacing = std::sqrt(area / double(patches.count()) / 16);
    SolveSettings settings;
    settings.bundles = 512;
    settings.line_spacing = spacing;
    settings.first_shot = FirstShot::off;
    settings.directions = DirectionSet::random;
    settings.batch = 1;
    std::vector<Sample> ours = over_seeds(scene, patches, settings, 32);
    settings.method = Method::lines;
    std::vector<Sample> lines = over_seeds(scene, patches, settings, 32, 500);
    CHECK(worst_difference(ours, lines) < sidak_bound(patches.count(), 32));
    std::vector<Sample> naive(patches.count());
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        std::vector<double> run =
            first_line_takes_everything(scene, patches, 900 + seed, 512, spacing);
        for (std::size_t k = 0; k < run.size(); ++k)
            naive[k].add(run[k]);
    }
    double wrong = 0, weight = 0;
    for (std::size_t k = 0; k < patches.count(); ++k) {
        wrong += patches.area[k] * std::pow(naive[k].mean() - lines[k].mean(), 2);
        weight += patches.area[k] * std::pow(lines[k].mean(), 2);
    }
    MESSAGE("relative RMS of the naive rule: ", std::sqrt(wrong / weight));
    CHECK(std::sqrt(wrong / weight) > 0.05);
}

TEST_CASE("few bundles and large batches bring no bias that the leftover does not mend") {
    // In a furnace the mean is exact however few the bundles: κ closes the balance. Fails when the
    // unshot rest is dropped (then a run of 4 bundles at ρ = 0.9 shows a fraction of the light).
    Scene scene = room(grey(0.9, 1), 3);
    Patches patches = make_patches(scene);
    for (std::uint64_t bundles : {4, 16, 64}) {
        SolveSettings settings;
        settings.bundles = bundles;
        settings.first_shot = FirstShot::off;
        Sample mean = mean_over_seeds(scene, patches, settings, 32);
        CHECK(mean.mean() == doctest::Approx(10).epsilon(1e-3));
    }
}

TEST_CASE("the error falls with the lines as it must") {
    // Quadratic error of random directions ∝ 1 / bundles: slope -1 ± 0.15 over nine powers of two;
    // the lattice no slower. Fails when bundles repeat each other (planted: index % 256).
    Scene scene = cube_in_cube();
    Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.first_shot = FirstShot::off;
    settings.bundles = 1 << 16;
    std::vector<Sample> truth = over_seeds(scene, patches, settings, 4, 77);
    for (DirectionSet set : {DirectionSet::random, DirectionSet::lattice}) {
        settings.directions = set;
        double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
        int points = 0;
        for (int power = 5; power <= 14; power += 3) {
            settings.bundles = std::uint64_t(1) << power;
            double error = 0;
            for (std::uint64_t seed = 0; seed < 24; ++seed) {
                settings.seed = 100 + seed;
                Solution run = solve(scene, patches, settings);
                for (std::size_t k = 0; k < patches.count(); ++k)
                    error += patches.area[k] * std::pow(run.radiosity[k] - truth[k].mean(), 2);
            }
            double x = power * std::log(2.0), y = std::log(error);
            sum_x += x;
            sum_y += y;
            sum_xx += x * x;
            sum_xy += x * y;
            ++points;
        }
        double slope = (points * sum_xy - sum_x * sum_y) / (points * sum_xx - sum_x * sum_x);
        MESSAGE("slope: ", slope);
        CHECK(slope < -0.85);
        if (set == DirectionSet::random)
            CHECK(slope > -1.15);
    }
}
