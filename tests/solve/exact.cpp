#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

#include "parallux/solve.h"
#include "support/hand_made.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

TEST_CASE("a furnace glows with E / (1 - rho) all over") {
    // 32 seeds; each patch below the Šidák bound, the mean over 128 below that of all 14 cases.
    // The control: a reflectance used twice (ρ² for ρ) must be seen.
    for (double rho : {0.0, 0.1, 0.5, 0.9}) {
        Scene scene = room(grey(rho, 1), 4);
        add_turned_cube(scene, {0.4, 0.5, 0.45}, 0.3, 2, grey(rho, 1));
        Patches patches = make_patches(scene);
        for (FirstShot shot : {FirstShot::off, FirstShot::rays})
            for (Method method : {Method::bundles, Method::lines}) {
                if (shot == FirstShot::off && rho == 0)
                    continue;  // B = E whatever the lines do
                SolveSettings settings;
                settings.first_shot = shot;
                settings.method = method;
                settings.bundles = 128;
                settings.batch = 2;
                std::vector<Sample> samples = over_seeds(scene, patches, settings, 32);
                double truth = 1 / (1 - static_cast<double>(static_cast<float>(rho)));
                double bound = sidak_bound(patches.count(), 32);
                CHECK(worst_z(samples, [&](std::size_t) { return truth; }) < bound);
                Sample mean = mean_over_seeds(scene, patches, settings, 128);
                CHECK(std::fabs(mean.z(truth)) < sidak_bound(14, 128));
                if (rho > 0)
                    CHECK(worst_z(samples, [&](std::size_t) { return 1 / (1 - rho * rho); }) >
                          bound);
            }
    }
}

namespace {

// n_ij / n_i of a unit cube's floor and ceiling to each other and to a wall from `bundles` bundles
// of random directions, as means over 50 groups of bundles. `skew` plants an error in the
// directions. Not over all six faces: an error along one axis would cancel to first order.
void cube_factors(std::uint64_t bundles, double spacing, double skew, Sample& opposite,
                  Sample& adjacent, std::uint64_t& lines) {
    Scene scene = room(grey(0.5), 1);
    Patches patches = make_patches(scene);
    Projector projector(scene, patches);
    auto workspace = projector.make_workspace();
    Projection projection;
    IntersectionLists lists;
    for (int group = 0; group < 50; ++group) {
        double counts[2] = {}, total = 0;
        for (std::uint64_t k = 0; k < bundles / 50; ++k) {
            Bundle bundle = make_bundle({21, bundles, DirectionSet::random, spacing},
                                        std::uint64_t(group) * (bundles / 50) + k);
            if (skew != 1) {
                bundle.direction = glm::normalize(bundle.direction * glm::dvec3(1, 1, skew));
                bundle.x = glm::normalize(bundle.x -
                                          glm::dot(bundle.x, bundle.direction) * bundle.direction);
                bundle.y = glm::cross(bundle.direction, bundle.x);
            }
            projector.project(bundle, projection);
            for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
                projector.lists(projection, tile, *workspace, lists);
                lines += lists.lines();
                for (std::size_t line = 0; line < lists.lines(); ++line) {
                    if (lists.start[line + 1] - lists.start[line] != 2)
                        continue;
                    const Hit* hit = &lists.hits[lists.start[line]];
                    // Faces 4 and 5 are floor and ceiling; both ends of a line are exits.
                    double exits = double(hit[0].surface >= 4) + double(hit[1].surface >= 4);
                    counts[exits == 2 ? 0 : 1] += exits;
                    total += exits;
                }
            }
        }
        opposite.add(counts[0] / total);
        adjacent.add(counts[1] / total / 4);
    }
}

}  // namespace

TEST_CASE("form factors of the unit cube at 1e8 lines") {
    // The control: directions flattened by 7 % along z must be seen.
    Sample opposite, adjacent;
    std::uint64_t lines = 0;
    cube_factors(20000, 0.016, 1, opposite, adjacent, lines);
    CHECK(lines > 100'000'000);
    CHECK(std::fabs(opposite.z(0.199824895698)) < 4);
    CHECK(std::fabs(adjacent.z(0.200043776075)) < 4);
    Sample wrong_opposite, wrong_adjacent;
    cube_factors(20000, 0.05, 0.93, wrong_opposite, wrong_adjacent, lines);
    CHECK(std::fabs(wrong_opposite.z(0.199824895698)) > 4);
    CHECK(std::fabs(wrong_adjacent.z(0.200043776075)) > 4);
}

TEST_CASE("a cube lit by one face agrees with the dense solution") {
    // Exact factors; B of emitter, opposite and adjacent faces from the 3 × 3 system of symmetry.
    double p = 0.199824895698, q = 0.200043776075, rho = 0.5;
    // Unknown irradiances: emitter a, opposite b, adjacent c. Solved by sweeps to rounding.
    double a = 0, b = 0, c = 0;
    for (int sweep = 0; sweep < 200; ++sweep) {
        double Ba = 1 + rho * a, Bb = rho * b, Bc = rho * c;
        a = p * Bb + 4 * q * Bc;
        b = p * Ba + 4 * q * Bc;
        c = q * (Ba + Bb) + (p + 2 * q) * Bc;
    }
    Material wall = grey(rho), light = grey(rho, 1);
    Scene scene = room({light, wall, wall, wall, wall, wall}, 1);
    Patches patches = make_patches(scene);
    for (Direction direction : {Direction::bidirectional, Direction::oriented})
        for (FirstShot shot : {FirstShot::off, FirstShot::rays})
            for (Method method : {Method::bundles, Method::lines})
                for (DirectionSet set : {DirectionSet::lattice, DirectionSet::random}) {
                    SolveSettings settings;
                    settings.direction = direction;
                    settings.first_shot = shot;
                    settings.first_shot_rays = 20000;
                    settings.method = method;
                    settings.directions = set;
                    settings.bundles = 1024;
                    settings.batch = 16;
                    std::vector<Sample> samples = over_seeds(scene, patches, settings, 32);
                    double bound = sidak_bound(6 * 16, 32);
                    auto truth = [&](std::size_t k) {
                        return k == 0 ? 1 + rho * a : rho * (k == 1 ? b : c);
                    };
                    CHECK(worst_z(samples, truth) < bound);
                }
}

TEST_CASE("open to a uniform sky, a plate gets pi L and a wall half of it") {
    // Unobstructed: F to the sky is 1 for a plate looking up under a sky all round, whatever its
    // tilt; under a gradient that is dark below the horizon a wall gets half.
    Scene scene;
    scene.bands = 2;
    scene.materials = {grey(0.3)};
    scene.objects = {"plate"};
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    Surface plate;
    plate.corner = {0, 1, 2, 3};
    plate.grid_u = plate.grid_v = 2;
    scene.surfaces = {plate};
    scene.sky.kind = Sky::Kind::uniform;
    scene.sky.zenith = Spectrum::constant(2);
    scene.sky.zenith[1] = 4;
    Patches patches = make_patches(scene);
    for (Method method : {Method::bundles, Method::lines}) {
        SolveSettings settings;
        settings.method = method;
        settings.batch = 16;
        std::vector<Sample> samples = over_seeds(scene, patches, settings, 32);
        auto truth = [&](std::size_t k) { return 0.3f * pi * (k % 2 ? 4 : 2); };
        CHECK(worst_z(samples, truth) < sidak_bound(16, 32));
    }
    // Stand it up under the gradient.
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    scene.sky.kind = Sky::Kind::gradient;
    scene.sky.zenith = scene.sky.horizon = Spectrum::constant(2);
    std::vector<Sample> samples = over_seeds(scene, patches, {}, 32);
    CHECK(worst_z(samples, [&](std::size_t) { return 0.3f * pi; }) < sidak_bound(8, 32));
}

TEST_CASE("point, spot and directional lights meet their closed forms, and shadows are black") {
    // A floor patch of 1 cm under a point light at 2 m: H = I cos³ / h². Fails when cos or 1/r² is
    // missing, or when the shadow ray is not cast.
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(0.5)};
    scene.objects = {"floor"};
    auto quad = [&](glm::dvec3 origin, double side) {
        auto first = std::uint32_t(scene.positions.size());
        for (glm::dvec3 p : {glm::dvec3(0), glm::dvec3(side, 0, 0), glm::dvec3(side, side, 0),
                             glm::dvec3(0, side, 0)})
            scene.positions.push_back(origin + p);
        Surface surface;
        surface.corner = {first, first + 1, first + 2, first + 3};
        surface.grid_u = surface.grid_v = 1;
        scene.surfaces.push_back(surface);
    };
    quad({-0.005, -0.005, 0}, 0.01);
    quad({0.995, -0.005, 0}, 0.01);
    quad({2.995, -0.005, 0}, 0.01);
    // A lid halfway between the light and the third patch.
    quad({1.3, -0.2, 1}, 0.4);
    Light light;
    light.kind = Light::Kind::point;
    light.position = {0, 0, 2};
    light.intensity = Spectrum::constant(100);
    scene.lights = {light};
    Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.bundles = 16;
    Solution solution = solve(scene, patches, settings);
    CHECK(solution.irradiance[0] == doctest::Approx(25).epsilon(1e-4));
    CHECK(solution.irradiance[1] == doctest::Approx(100 * 2 / std::pow(5, 1.5)).epsilon(1e-4));
    CHECK(solution.irradiance[2] == 0);
    scene.lights[0].kind = Light::Kind::spot;
    scene.lights[0].outer_cone = 0.4;
    solution = solve(scene, patches, settings);
    CHECK(solution.irradiance[0] == doctest::Approx(25).epsilon(1e-4));
    CHECK(solution.irradiance[1] == 0);  // atan(1/2) = 0.46 lies beyond the cone
    scene.lights[0].kind = Light::Kind::directional;
    scene.lights[0].direction = glm::normalize(glm::dvec3(0, 1, -1));
    solution = solve(scene, patches, settings);
    CHECK(solution.irradiance[0] == doctest::Approx(100 / std::sqrt(2)).epsilon(1e-4));
    CHECK(solution.energy.residual[0] == 0);
}
