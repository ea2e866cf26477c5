#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

#include "parallux/solve.h"
#include "support/hand_made.h"

using namespace parallux;
using namespace parallux::test;

namespace {

constexpr double degree = pi / 180;

// Square millimetres of floor here and there.
Scene floor_of(const std::vector<glm::dvec3>& places) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(0.5)};
    scene.objects = {"floor"};
    for (const glm::dvec3& place : places)
        add_quad(scene, place - glm::dvec3(5e-4, 5e-4, 0), {1e-3, 0, 0}, {0, 1e-3, 0});
    return scene;
}

std::vector<float> lit(const Scene& scene) {
    SolveSettings settings;
    settings.bundles = 8;
    const Solution solution = solve(scene, make_patches(scene), settings);
    CHECK(solution.energy.residual[0] == 0);
    return solution.irradiance;
}

Light sun(double elevation) {
    Light light;
    light.kind = Light::Kind::directional;
    light.direction = -glm::dvec3(std::cos(elevation), 0, std::sin(elevation));
    light.intensity = Spectrum::constant(800);
    light.half_angle = sun_half_angle;
    return light;
}

}  // namespace

TEST_CASE("a sun's disc in the open brings what its middle would, half of it at the horizon") {
    // Planted, seen: the part of the disc that lies below the horizon counted in; a disc of twice
    // the radius; places even in the radius, not in area.
    Scene scene = floor_of({{0, 0, 0}});
    for (double elevation : {0.3 * degree, 10 * degree, 60 * degree, 90 * degree}) {
        scene.lights = {sun(elevation)};
        CHECK(lit(scene)[0] == doctest::Approx(800 * std::sin(elevation)).epsilon(1e-6));
    }
    // ∫ of height over half a disc of radius s, over the whole: 2 s / (3 π).
    scene.lights = {sun(0)};
    const double s = std::sin(sun_half_angle);
    CHECK(lit(scene)[0] == doctest::Approx(800 * 2 * s / (3 * pi)).epsilon(0.02));
    scene.lights = {sun(-0.3 * degree)};
    CHECK(lit(scene)[0] == 0);
}

TEST_CASE("a straight edge casts a penumbra of the disc's width") {
    // A sun in the zenith and a lid 10 m above, whose edge hides all of the disc beyond x: what is
    // seen is a segment of it. Planted, seen: a disc of twice the radius; places even in the
    // radius.
    const double radius = 10 * std::tan(sun_half_angle);
    std::vector<glm::dvec3> places;
    const std::vector<double> at = {-1.2, -0.8, -0.5, 0, 0.3, 0.7, 1.2};
    for (double x : at)
        places.push_back({x * radius, 0, 0});
    Scene scene = floor_of(places);
    add_quad(scene, {0, -5, 10}, {5, 0, 0}, {0, 10, 0});
    scene.lights = {sun(pi / 2)};
    const std::vector<float> irradiance = lit(scene);
    for (std::size_t k = 0; k < at.size(); ++k) {
        const double x = std::min(1.0, std::max(-1.0, -at[k]));
        const double seen = 0.5 + (std::asin(x) + x * std::sqrt(1 - x * x)) / pi;
        CAPTURE(at[k]);
        // 64 places over the disc: off by at most three of them.
        CHECK(std::fabs(irradiance[k] / 800 - seen) <= 3.0 / 64);
    }
}

TEST_CASE("lights as KHR_lights_punctual has them: cones fall off, ranges end") {
    // The extension's advice: the square of how far the cosine is from the outer cone's to the
    // inner one's. Planted, seen: not the square; a range in centimetres.
    Scene scene = floor_of({{0, 0, 0}, {0.6, 0, 0}, {1, 0, 0}, {3, 0, 0}});
    Light spot;
    spot.kind = Light::Kind::spot;
    spot.position = {0, 0, 2};
    spot.intensity = Spectrum::constant(100);
    spot.inner_cone = 0.2;
    spot.outer_cone = 0.5;
    scene.lights = {spot};
    auto plain = [](double x) { return 100 * 2 / std::pow(4 + x * x, 1.5); };
    auto falls = [&](double x) {
        const double t = (2 / std::hypot(2, x) - std::cos(0.5)) / (std::cos(0.2) - std::cos(0.5));
        return t * t;
    };
    std::vector<float> irradiance = lit(scene);
    CHECK(irradiance[0] == doctest::Approx(plain(0)).epsilon(1e-5));
    CHECK(irradiance[1] == doctest::Approx(plain(0.6) * falls(0.6)).epsilon(1e-3));
    CHECK(irradiance[2] == doctest::Approx(plain(1) * falls(1)).epsilon(5e-3));
    CHECK(irradiance[3] == 0);
    scene.lights[0].kind = Light::Kind::point;
    scene.lights[0].range = 3;
    irradiance = lit(scene);
    CHECK(irradiance[2] == doctest::Approx(plain(1)).epsilon(1e-5));
    CHECK(irradiance[3] == 0);
    scene.lights[0].range = 4;
    CHECK(lit(scene)[3] == doctest::Approx(plain(3)).epsilon(1e-5));
}
