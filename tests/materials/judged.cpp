#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "materials/shiny.h"
#include "parallux/scatter.h"
#include "reference/path_tracer.h"
#include "support/seeds.h"

// Five mixed scenes against the path tracer, every patch and band.

using namespace parallux;
using namespace parallux::test;

namespace {

Spectrum colour(double r, double g, double b) {
    Spectrum s;
    s[0] = static_cast<float>(r), s[1] = static_cast<float>(g), s[2] = static_cast<float>(b);
    return s;
}

Scene painted_room() {
    Scene scene = room({grey(0.6), grey(0.6), grey(0.7), grey(0.7), grey(0.5), grey(0.8)}, 2);
    scene.bands = 3;
    scene.materials[0].reflectance = colour(0.7, 0.2, 0.1);
    scene.materials[1].reflectance = colour(0.1, 0.3, 0.7);
    add_plate(scene, {0.3, 0.35, 0.99}, {0, 0.3, 0}, {0.4, 0, 0}, emitting(grey(0.1), 5));
    return scene;
}

// A lamp, a coloured mirror, a body of coloured glass.
Scene mirror_and_glass() {
    Scene scene = painted_room();
    Material gold = mirror(0);
    gold.specular.colour = colour(0.9, 0.6, 0.2);
    gold.specular.grazing = Spectrum::constant(1);
    add_turned_cube(scene, {0.3, 0.35, 0.3}, 0.3, 1, gold);
    Material green = glass(1.5);
    green.specular.absorption = colour(6, 1, 4);
    add_turned_cube(scene, {0.7, 0.6, 0.3}, 0.3, 1, green);
    return scene;
}

// Rough walls, and a polished floor.
Scene rough_and_polished() {
    Scene scene = painted_room();
    scene.materials[3] = mirror(0.8, 0.6);
    scene.materials[4] = mirror(0.9, 0, 0.4, 0.6);
    add_block(scene, {0.2, 0.3, 0.1}, {0.4, 0.5, 0.6}, mirror(0.7, 0.8, 0.5, 0.4));
    return scene;
}

// A room with a window of thin glass under an open sky, and a mirror across.
Scene window() {
    Scene scene = room({grey(0.6), grey(0.6), grey(0.7), grey(0.7), grey(0.5), grey(0.8)}, 3);
    Material pane = glass(1.5, 0, true);
    pane.specular.colour = Spectrum::constant(0.9f);
    pane.specular.share = 0.8f;
    pane.reflectance = Spectrum::constant(0.5f);
    scene.materials[0] = pane;
    add_plate(scene, {0.95, 0.2, 0.2}, {0, 0, 0.6}, {0, 0.6, 0}, mirror(0.9));
    scene.sky.kind = Sky::Kind::gradient;
    scene.sky.zenith = Spectrum::constant(2);
    scene.sky.horizon = Spectrum::constant(1);
    scene.sky.ground = Spectrum::constant(0.2f);
    return scene;
}

// A wide sun into a room through a roof of glass, past a mirror and through a block. Without the
// roof it would reach the walls by itself as well, along shadow rays to fixed places, whose error
// is the same in all runs.
Scene sunlit() {
    Scene scene = room({grey(0.4), grey(0.6), grey(0.3), grey(0.5), grey(0.5), {}}, 3);
    scene.materials[5] = glass(1.5, 0, true);
    add_plate(scene, {0.9, 0.1, 0.1}, {0, 0.2, 0.6}, {0, 0.7, 0}, mirror(0.9));
    add_block(scene, {0.3, 0.2, 0.2}, {0.6, 0.5, 0.4}, glass(1.5, 1));
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(glm::dvec3(0.5, 0.2, -1));
    sun.half_angle = 0.25;
    sun.intensity = Spectrum::constant(1);
    scene.lights = {sun};
    scene.sky.kind = Sky::Kind::uniform;
    scene.sky.zenith = Spectrum::constant(0.1f);
    return scene;
}

// Balls of glass and metal, under a leaf that lets light through.
Scene balls() {
    Scene scene = painted_room();
    add_ball(scene, {0.3, 0.3, 0.25}, 0.2, 6, glass(1.5));
    Material steel = mirror(0.6, 0.5);
    steel.specular.grazing = Spectrum::constant(1);
    add_ball(scene, {0.7, 0.7, 0.25}, 0.2, 6, steel);
    Material leaf = grey(0.2, 0, true);
    leaf.transmittance = Spectrum::constant(0.4f);
    add_plate(scene, {0.2, 0.2, 0.8}, {0.6, 0, 0}, {0, 0.6, 0}, leaf);
    return scene;
}

// A stone in a block of glass, both of which absorb.
Scene stone_in_glass() {
    Scene scene = painted_room();
    add_block(scene, {0.3, 0.3, 0.1}, {0.7, 0.7, 0.5}, glass(1.5, 2));
    add_turned_cube(scene, {0.5, 0.5, 0.3}, 0.2, 1, emitting(grey(0.5), 1));
    return scene;
}

void judge(const Scene& scene, const SolveSettings& settings, std::uint64_t paths) {
    const Patches patches = make_patches(scene);
    constexpr int seeds = 64;
    const std::vector<Sample> samples = over_seeds(scene, patches, settings, seeds);
    PathSettings path_settings;
    path_settings.paths = paths;
    const std::vector<PathEstimate> traced = traced_irradiance(scene, patches, path_settings);
    double worst = 0, squares = 0, power = 0, difference = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (patches.specular_share(k / patches.bands) == 1)
            continue;
        auto of = [&](std::size_t at) -> const PathEstimate& { return traced[at / patches.bands]; };
        const auto band = static_cast<std::uint32_t>(k % patches.bands);
        const double expected = patches.emission[k] + scattered(patches, k, [&](std::size_t at) {
                                    return of(at).mean[band];
                                });
        const double error =
            scattered(patches, k, [&](std::size_t at) { return of(at).error[band]; });
        const double z = (samples[k].mean() - expected) /
                         std::max(1e-12, std::hypot(samples[k].standard_error(), error));
        if (std::fabs(z) > worst)
            worst = std::fabs(z);
        squares += z * z;
        const double area = patches.area[k / patches.bands];
        power += area * (expected - patches.emission[k]);
        difference += area * (samples[k].mean() - expected);
        ++count;
    }
    MESSAGE(count << " values: largest |z| " << worst << ", root mean square "
                  << std::sqrt(squares / double(count)) << ", all reflected light off by "
                  << 100 * difference / power << " %");
    CHECK(worst < sidak_bound(count, seeds));
    CHECK(squares / double(count) < 1.5);
}

SolveSettings bundles(std::uint64_t count) {
    SolveSettings settings;
    settings.bundles = count;
    settings.groups = 1;
    settings.first_shot_rays = 20'000;
    return settings;
}

}  // namespace

TEST_CASE("judged by paths: a coloured mirror and coloured glass") {
    judge(mirror_and_glass(), bundles(256), 100'000);
}
TEST_CASE("judged by paths: rough mirrors and a polished floor") {
    judge(rough_and_polished(), bundles(256), 100'000);
}
TEST_CASE("judged by paths: sky through a window") {
    judge(window(), bundles(256), 60'000);
}
TEST_CASE("judged by paths: a wide sun past a mirror and through glass") {
    judge(sunlit(), bundles(128), 100'000);
}
TEST_CASE("judged by paths: balls of glass and metal under a leaf") {
    judge(balls(), bundles(256), 100'000);
}
TEST_CASE("judged by paths: a stone in glass") {
    judge(stone_in_glass(), bundles(256), 100'000);
}
// The same without first shots: emission goes along the lines.
TEST_CASE("judged by paths: without first shots") {
    SolveSettings settings = bundles(256);
    settings.first_shot = FirstShot::off;
    settings.first_shot_rays = 0;
    judge(rough_and_polished(), settings, 100'000);
}

// The judge itself, where nothing shines.
TEST_CASE("judged by paths: a diffuse room") {
    Scene scene = painted_room();
    add_turned_cube(scene, {0.3, 0.35, 0.3}, 0.3, 1, grey(0.5));
    judge(scene, bundles(256), 100'000);
}
