#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>

#include "parallux/solve.h"
#include "scene/sky_models.h"
#include "support/hand_made.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

constexpr double degree = pi / 180;

// One plate of one metre a side with nothing around it: it looks up, or south.
Scene plate(bool upright) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(0.5)};
    scene.objects = {"plate"};
    if (upright)
        scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    else
        scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    Surface surface;
    surface.corner = {0, 1, 2, 3};
    surface.grid_u = surface.grid_v = 1;
    scene.surfaces = {surface};
    return scene;
}

// Irradiance by quadrature over the whole sphere, midpoints of elevation and azimuth.
double quadrature(const Sky& sky, const glm::dvec3& normal) {
    constexpr int rings = 1000, round = 1000;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double h = ((i + 0.5) / rings - 0.5) * pi;
        for (int k = 0; k < round; ++k) {
            const glm::dvec3 seen = sky_direction(sky, h, 2 * pi * (k + 0.5) / round);
            const double cosine = glm::dot(normal, seen);
            if (cosine > 0)
                sum += cosine * std::cos(h) * sky.radiance(seen)[0];
        }
    }
    return sum * pi / rings * 2 * pi / round;
}

// Irradiances of runs over 32 seeds.
Sample irradiance(const Scene& scene) {
    SolveSettings settings;
    settings.bundles = 2048;
    settings.groups = 1;
    settings.line_spacing = 0.1;
    Sample result;
    const double rho = static_cast<double>(scene.materials[0].reflectance[0]);
    for (const std::vector<float>& run : runs(scene, make_patches(scene), settings, 32, 1))
        result.add(run[0] / rho);
    return result;
}

struct Case {
    std::string name;
    SkySettings sky;
    double up, south;  // closed forms; 0: by quadrature
};

std::vector<Case> cases() {
    using Model = SkySettings::Model;
    SkySettings sky;
    sky.radiance = Spectrum::constant(2);
    sky.diffuse = Spectrum::constant(150);
    std::vector<Case> all;
    sky.model = Model::uniform;
    all.push_back({"uniform, no horizon", sky, 2 * pi, 2 * pi});
    sky.has_ground = true;  // black
    all.push_back({"uniform", sky, 2 * pi, pi});
    // 2/3 (π/4 + 2/3) L_z on a wall.
    sky.model = Model::overcast;
    all.push_back({"overcast", sky, 7 * pi * 2 / 9, 2 * (pi / 6 + 4.0 / 9)});
    sky.has_sun = true;
    sky.elevation = 35 * degree;
    sky.azimuth = 160 * degree;
    sky.albedo = Spectrum::constant(0.3f);
    sky.model = Model::clear;
    all.push_back({"clear", sky, 0, 0});
    sky.model = Model::perez;
    for (double direct : {0.0, 20.0, 150.0, 600.0}) {
        sky.direct = Spectrum::constant(static_cast<float>(direct));
        all.push_back({"perez", sky, 150, 0});
    }
    return all;
}

}  // namespace

TEST_CASE("plates in the open meet every sky's closed form or quadrature to 0.1 %") {
    // Planted, seen: L in the place of π L a line; the sky behind a line taken for the one ahead.
    for (const Case& one : cases())
        for (bool upright : {false, true}) {
            Scene scene = plate(upright);
            REQUIRE(!put_sky(scene, one.sky));
            scene.lights.clear();  // the sun's disc is another test's
            const double closed = upright ? one.south : one.up;
            const glm::dvec3 normal = upright ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
            const double truth = closed > 0 ? closed : quadrature(scene.sky, normal);
            CAPTURE(one.name);
            CAPTURE(upright);
            CAPTURE(truth);
            CHECK(quadrature(scene.sky, normal) == doctest::Approx(truth).epsilon(1e-3));
            const Sample sample = irradiance(scene);
            CAPTURE(sample.mean());
            CAPTURE(sample.standard_error());
            CHECK(std::fabs(sample.mean() / truth - 1) < 1e-3);
            CHECK(std::fabs(sample.mean() - truth) <
                  sidak_bound(16, 32) * sample.standard_error() + 1e-4 * truth);
        }
}

TEST_CASE("a sky picture lights plates as its quadrature says") {
    // A bright quarter; how it stands is held by tests/scene/surface_test.cpp. Planted, seen: the
    // sky behind a line taken for the one ahead.
    for (bool upright : {false, true}) {
        Scene scene = plate(upright);
        scene.sky.kind = Sky::Kind::image;
        scene.sky.image.width = 16;
        scene.sky.image.height = 8;
        scene.sky.scale = 2;
        for (int row = 0; row < 8; ++row)
            for (int column = 0; column < 16; ++column)
                scene.sky.image.texels.push_back(glm::vec3(row >= 4       ? 0.1f
                                                           : column >= 12 ? 3.0f
                                                                          : 1.0f));
        const double truth =
            quadrature(scene.sky, upright ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1));
        const Sample sample = irradiance(scene);
        CHECK(std::fabs(sample.mean() / truth - 1) < 1e-3);
    }
}

TEST_CASE("under Perez's sky the balance closes, and threads change no bit") {
    Scene scene = room({grey(0.7), grey(0.6), grey(0.5), grey(0.4), grey(0.3), grey(0.6)}, 4);
    scene.surfaces.pop_back();  // no ceiling
    SkySettings sky;
    sky.model = SkySettings::Model::perez;
    sky.diffuse = Spectrum::constant(120);
    sky.direct = Spectrum::constant(500);
    sky.has_sun = true;
    sky.elevation = 50 * degree;
    sky.azimuth = 200 * degree;
    REQUIRE(!put_sky(scene, sky));
    const Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.bundles = 200;
    std::uint64_t hash = 0;
    for (unsigned threads : {1u, 2u, 7u}) {
        settings.threads = threads;
        const Solution solution = solve(scene, patches, settings);
        CHECK(solution.energy.residual[0] == 0);
        if (threads == 1)
            hash = solution.hash;
        CHECK(solution.hash == hash);
    }
}
