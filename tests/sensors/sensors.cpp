#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "parallux/error.h"
#include "parallux/sensors.h"
#include "support/hand_made.h"
#include "support/statistics.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// A solution of one value of B and H, so that sensors alone are tested.
Solution given(const Patches& patches, double irradiance, double stderror = 0) {
    Solution solution;
    solution.bands = patches.bands;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        solution.irradiance.push_back(static_cast<float>(irradiance));
        solution.radiosity.push_back(
            static_cast<float>(patches.emission[k] + patches.reflectance[k] * irradiance));
        if (stderror > 0)
            solution.stderror.push_back(static_cast<float>(stderror));
    }
    return solution;
}

// Adds a rectangle that looks along a × b.
void add_quad(Scene& scene, glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, const Material& material) {
    Surface surface;
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (glm::dvec3 corner : {p, p + a, p + a + b, p + b})
        scene.positions.push_back(corner);
    surface.corner = {first, first + 1, first + 2, first + 3};
    surface.material = static_cast<std::uint32_t>(scene.materials.size());
    surface.grid_u = surface.grid_v = 4;
    scene.materials.push_back(material);
    scene.objects = {"all"};
    scene.surfaces.push_back(surface);
}

// Form factor from a point that looks up to a rectangle 0 … a, 0 … b at height h.
double corner_factor(double a, double b, double h) {
    const double x = a / std::hypot(a, h), y = b / std::hypot(b, h);
    return (x * std::atan(b / std::hypot(a, h)) + y * std::atan(a / std::hypot(b, h))) / (2 * pi);
}

}  // namespace

TEST_CASE("under a uniform sky an unobstructed sensor has π L, from a lit plate below B too") {
    // Fails (planted, seen) without the π, or when sensors upon a surface hit it.
    Scene scene;
    scene.bands = 2;
    add_quad(scene, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, grey(0.5));
    scene.sky.kind = Sky::Kind::uniform;
    scene.sky.zenith[0] = 2;
    scene.sky.zenith[1] = 3;
    const Patches patches = make_patches(scene);
    const std::vector<Sensor> sensors = {{"air", {0.1, 0.2, 1}, {0, 0, 1}},
                                         {"ground", {0.1, 0.2, 0}, {0, 0, 1}},
                                         {"far", {1, 7, 3}, glm::normalize(glm::dvec3(0, 1, 9))},
                                         {"down", {0.1, 0.2, 0.001}, {0, 0, -1}}};
    const SensorReadings readings = sense(scene, patches, given(patches, 8), sensors);
    for (std::size_t s : {0u, 1u})
        for (std::uint32_t band = 0; band < 2; ++band) {
            CHECK(readings.irradiance[2 * s + band] ==
                  doctest::Approx(pi * (band ? 3 : 2)).epsilon(1e-6));
            CHECK(readings.stderror[2 * s + band] < 1e-6);
        }
    CHECK(readings.irradiance[6] == doctest::Approx(4).epsilon(1e-3));
    CHECK(readings.solution_error.empty());
}

TEST_CASE("in a furnace every sensor reads E / (1 - rho), inside or on a wall") {
    // Fails (planted, seen) when emission counts in both kinds of rays, or the weight of one is
    // that of the other.
    Scene scene = room(grey(0.5, 1), 4);
    const Patches patches = make_patches(scene);
    std::vector<Sensor> sensors;
    for (int k = 0; k < 24; ++k)
        sensors.push_back({"",
                           {0.04 * k, 0.03 + 0.035 * k, 0.04 * (23 - k)},
                           glm::normalize(glm::dvec3(1 - 0.1 * k, 0.3, 0.05 * k - 0.4))});
    sensors[0] = {"wall", {0, 0.5, 0.5}, {1, 0, 0}};
    sensors.back() = {"ceiling", {0.3, 0.4, 1}, {0, 0, -1}};
    const SensorReadings readings = sense(scene, patches, given(patches, 2, 0.01), sensors);
    const double bound = sidak_bound(sensors.size(), 16);
    for (std::size_t s = 0; s < sensors.size(); ++s) {
        CHECK(std::fabs(readings.irradiance[s] - 2) <= bound * readings.stderror[s] + 1e-6);
        CHECK(readings.stderror[s] < 5e-3);
        CHECK(readings.solution_error[s] == doctest::Approx(0.01));
    }
}

TEST_CASE("a lamp overhead: the point's form factor, shadows black, bits the same") {
    // Fails (planted, seen) when the lamp's cosine is left out.
    Scene scene;
    scene.bands = 1;
    add_quad(scene, {0, 0, 1}, {0, 0.2, 0}, {0.3, 0, 0}, grey(0, 1000));  // looks down
    add_quad(scene, {-3, -5, 0.5}, {0, 5.5, 0}, {1.5, 0, 0}, grey(0, 0, true));
    const Patches patches = make_patches(scene);
    std::vector<Sensor> sensors;
    for (int k = 0; k < 16; ++k)
        sensors.push_back({"", {0, 0, 0.02 + 0.06 * k}, {0, 0, 1}});
    sensors.push_back({"shadow", {-4.8, 0.1, 0}, {0, 0, 1}});
    SensorReadings readings = sense(scene, patches, given(patches, 0), sensors);
    const double bound = sidak_bound(16, 16);
    for (std::size_t s = 0; s < 16; ++s) {
        const double truth = 1000 * corner_factor(0.3, 0.2, 1 - sensors[s].position.z);
        const double z = (readings.irradiance[s] - truth) / readings.stderror[s];
        CAPTURE(s);
        CAPTURE(truth);
        CHECK(std::fabs(z) < bound);
        CHECK(readings.stderror[s] < 0.005 * truth);
    }
    CHECK(readings.irradiance[16] == 0);
    for (unsigned threads : {1u, 2u, 7u}) {
        SensorSettings settings;
        settings.threads = threads;
        CHECK(sense(scene, patches, given(patches, 0), sensors, settings).irradiance ==
              readings.irradiance);
    }
}

TEST_CASE("a point light is read without noise") {
    Scene scene;
    scene.bands = 1;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, grey(0.5));
    Light light;
    light.position = {0, 0, 2};
    light.intensity = Spectrum::constant(100);
    scene.lights = {light};
    const Patches patches = make_patches(scene);
    const SensorReadings readings =
        sense(scene, patches, given(patches, 0), {{"", {0, 0, 0}, {0, 0, 1}}});
    CHECK(readings.irradiance[0] == doctest::Approx(25).epsilon(1e-5));
    CHECK(readings.stderror[0] == 0);
}

// Planted, seen: a disc's places of one point of a cell alone.
TEST_CASE("a sensor sees the half of a sun's disc that is above its plane, and its shadows") {
    Scene scene;
    scene.bands = 1;
    add_quad(scene, {-9, -9, -9}, {1, 0, 0}, {0, 1, 0}, grey(0));
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = {-1, 0, 0};
    sun.half_angle = sun_half_angle;
    sun.intensity = Spectrum::constant(1000);
    scene.lights = {sun};
    const std::vector<Sensor> sensors = {{"up", {0, 0, 0}, {0, 0, 1}},
                                         {"to it", {0, 0, 0}, {1, 0, 0}}};
    auto read = [&] {
        const Patches patches = make_patches(scene);
        return sense(scene, patches, given(patches, 0), sensors).irradiance;
    };
    // The mean over a disc of its height above the middle, where that is above.
    const double half = 1000 * std::sin(sun_half_angle) * 2 / (3 * pi);
    std::vector<double> seen = read();
    // 64 places, of which half count: 2 % off.
    CHECK(std::fabs(seen[0] - half) < 0.03 * half);
    CHECK(std::fabs(seen[1] - 1000) < 0.1);
    // A screen up to the sun's middle hides the lower half.
    add_quad(scene, {5, -9, -9}, {0, 0, 9}, {0, 18, 0}, grey(0, 0));
    seen = read();
    CHECK(std::fabs(seen[1] - 500) < 20);
}

TEST_CASE("a scene that repeats has no sensors") {
    Scene scene;
    scene.bands = 1;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey(0));
    scene.period[0] = {1, 0, 0};
    const Patches patches = make_patches(scene);
    CHECK_THROWS_AS(sense(scene, patches, given(patches, 0), {{"up", {0, 0, 1}, {0, 0, 1}}}),
                    Error);
}
