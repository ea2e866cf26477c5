#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "scene/sky_models.h"
#include "scene_files.h"

using namespace parallux;

namespace {

constexpr double degree = pi / 180;

std::string under(const std::string& sky, const std::string& more = "") {
    return R"({"parallux": 1, "surfaces": [{"parallelogram": [[0,0,0],[1,0,0],[0,1,0]]}], "sky": )" +
           sky + more + "}";
}

Scene scene_under(const TestFolder& folder, const std::string& sky, const std::string& more = "") {
    return load_scene(folder.write("sky.json", under(sky, more)));
}

// Irradiance of a plane that faces up, by finer steps than the library's.
double horizontal(const Sky& sky) {
    constexpr int rings = 2000, round = 720;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double h = (i + 0.5) / rings * pi / 2;
        double ring = 0;
        for (int k = 0; k < round; ++k)
            ring += sky.radiance(sky_direction(sky, h, 2 * pi * k / round))[0];
        sum += ring * std::sin(h) * std::cos(h);
    }
    return sum * pi / 2 / rings * 2 * pi / round;
}

}  // namespace

// Planted, seen: overcast brightest at the horizon; azimuth turning the other way; the ground lit
// by the sun's direct irradiance without the sine of its elevation.
TEST_CASE("skies of a Parallux scene: overcast, sun, ground") {
    TestFolder folder;
    Scene s = scene_under(folder, R"({"overcast": 9, "albedo": 0.5,
        "sun": {"elevation": 30, "azimuth": 90, "direct": [100, 200, 300]}})");
    CHECK(s.sky.radiance({0, 0, 1})[1] == doctest::Approx(9));
    CHECK(s.sky.radiance(glm::normalize(glm::dvec3(1, 0, 1e-9)))[1] == doctest::Approx(3));
    REQUIRE(s.lights.size() == 1);
    const Light& sun = s.lights[0];
    CHECK(sun.kind == Light::Kind::directional);
    CHECK(sun.half_angle == doctest::Approx(0.2665 * degree));
    // In the east: it shines to the west and down.
    CHECK(glm::distance(sun.direction, glm::dvec3(-std::sqrt(0.75), 0, -0.5)) < 1e-12);
    CHECK(sun.intensity[2] == 300);
    // 7 π L / 9 of the sky, half of the direct.
    const double both = 7 * pi + 100;
    CHECK(s.sky.radiance({0, 0, -1})[1] == doctest::Approx(0.5 * both / pi).epsilon(1e-4));
    // Without an albedo the ground is black, but that of a uniform sky, which has no horizon.
    CHECK(scene_under(folder, R"({"overcast": 9})").sky.radiance({0, 0, -1})[0] == 0);
    CHECK(scene_under(folder, R"({"uniform": 9})").sky.radiance({0, 0, -1})[0] == 9);
    s = scene_under(folder, R"({"uniform": 9, "albedo": 0.5})");
    CHECK(s.sky.radiance({0, 0, -1})[0] == doctest::Approx(4.5).epsilon(1e-4));
    CHECK(s.sky.radiance({0, 0, 1})[0] == 9);
    // With y up north is -z.
    s = scene_under(folder, R"({"sun": {"elevation": 0, "azimuth": 0, "direct": 1}})",
                    R"(, "up": [0, 1, 0])");
    CHECK(glm::distance(s.lights.at(0).direction, glm::dvec3(0, 0, 1)) < 1e-12);
}

TEST_CASE("mistakes in a sky are named") {
    TestFolder folder;
    auto fault = [&](const std::string& sky) {
        return fault_of(folder.write("x.json", under(sky)));
    };
    CHECK(holds(fault("{}"), "/sky: must have one of"));
    CHECK(holds(fault(R"({"clear": 1})"), "/sky: this sky needs a sun"));
    CHECK(holds(fault(R"({"perez": 1})"), "/sky: this sky needs a sun"));
    CHECK(holds(fault(R"({"clear": 1, "perez": 1, "sun": {"elevation": 1, "azimuth": 0}})"),
                "/sky: must have one of"));
    CHECK(holds(fault(R"({"overcast": 1, "sun": {"elevation": -1, "azimuth": 0}})"),
                "/sky/sun/elevation: -1 is outside"));
    CHECK(holds(fault(R"({"overcast": 1, "albedo": 1.5})"), "/sky/albedo"));
    CHECK(
        holds(fault(R"({"gradient": {"zenith": 1, "horizon": 1}, "albedo": 0.5})"), "/sky/albedo"));
    CHECK(holds(fault(R"({"overcast": 1, "north": [0, 0, 2]})"), "/sky/north: lies along up"));
}

TEST_CASE("the clear sky is Kittler's") {
    // (0.91 + 10 exp(-3 χ) + 0.45 cos² χ) (1 - exp(-0.32 / cos θ)) over the same at the zenith;
    // 0.91 is printed for 0.91017. Planted, seen: c = 9.
    TestFolder folder;
    const Sky sky =
        scene_under(folder, R"({"clear": 2, "sun": {"elevation": 50, "azimuth": 200}})").sky;
    auto f = [](double x) {
        return 0.91 + 10 * std::exp(-3 * x) + 0.45 * std::pow(std::cos(x), 2);
    };
    const double zenith = 2 / (f(40 * degree) * 0.27385);
    const glm::dvec3 sun = sky_direction(sky, 50 * degree, 200 * degree);
    for (double elevation : {1.0, 10.0, 50.0, 89.0})
        for (double azimuth : {0.0, 110.0, 200.0, 300.0}) {
            const glm::dvec3 seen = sky_direction(sky, elevation * degree, azimuth * degree);
            const double chi = std::acos(std::min(1.0, glm::dot(sun, seen)));
            const double expected =
                zenith * f(chi) * (1 - std::exp(-0.32 / std::sin(elevation * degree)));
            CHECK(sky.radiance(seen)[0] == doctest::Approx(expected).epsilon(5e-4));
        }
    CHECK(sky.radiance({0, 0, 1})[2] == doctest::Approx(2));
    CHECK(sky.radiance({0, 0, -1})[2] == 0);
}

TEST_CASE("Perez's sky gives the diffuse irradiance that was measured, in every bin") {
    // Planted, seen: normalised without the cosine of the plane.
    TestFolder folder;
    struct Hour {
        double elevation, direct, diffuse;
    };
    const Hour hours[] = {{3, 0, 10},     {3, 20, 20},    {3, 150, 25},   {20, 0, 60},
                          {20, 10, 100},  {20, 40, 120},  {20, 150, 120}, {20, 300, 100},
                          {20, 500, 90},  {20, 700, 70},  {55, 0, 150},   {55, 30, 300},
                          {55, 120, 320}, {55, 250, 300}, {55, 450, 250}, {55, 650, 150},
                          {55, 850, 90},  {88, 600, 250}, {90, 950, 100}};
    auto text = [](const Hour& hour) {
        return "{\"perez\": " + std::to_string(hour.diffuse) +
               ", \"sun\": {\"elevation\": " + std::to_string(hour.elevation) +
               ", \"azimuth\": 150, \"direct\": " + std::to_string(hour.direct) + "}}";
    };
    for (const Hour& hour : hours) {
        const Scene s = scene_under(folder, text(hour));
        CAPTURE(text(hour));
        CHECK(horizontal(s.sky) == doctest::Approx(hour.diffuse).epsilon(5e-4));
        CHECK(s.lights.size() == (hour.direct > 0));
        // Nowhere brighter than its bound, by which quanta are chosen.
        const double bound = s.sky.zenith[0] * s.sky.shape.bound();
        for (double h : {0.0, 1.0, hour.elevation, 90.0})
            for (double az : {0.0, 150.0})
                CHECK(s.sky.radiance(sky_direction(s.sky, h * degree, az * degree))[0] <=
                      bound * (1 + 1e-6));
    }
    // What no sky ever was.
    CHECK(holds(fault_of(folder.write("x.json", under(text({90, 60, 30})))), "gives no sky"));
}

TEST_CASE("a sky from the options takes the place of the file's") {
    TestFolder folder;
    const auto file = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    LoadSettings settings;
    settings.sky.model = SkySettings::Model::overcast;
    settings.sky.radiance = Spectrum::constant(3);
    settings.sky.has_sun = true;
    settings.sky.elevation = pi / 2;
    settings.sky.direct = Spectrum::constant(7);
    Scene s = load_scene(file, settings);
    CHECK(s.sky.radiance({0, 1, 0})[0] == 3);
    CHECK(glm::distance(s.lights.at(0).direction, glm::dvec3(0, -1, 0)) < 1e-12);
    // A scene's own sun sets where another rises, and its sky's meshes do not shine.
    const auto own = folder.write(
        "b.json", under(R"({"uniform": 1, "sun": {"elevation": 9, "azimuth": 9, "direct": 9}})",
                        R"(, "meshes": [{"file": "a.obj"}])"));
    CHECK(load_scene(own).lights.size() == 1);
    s = load_scene(own, settings);
    REQUIRE(s.lights.size() == 1);
    CHECK(s.lights[0].intensity[0] == 7);
    settings.sky.has_sun = false;
    settings.sky.model = SkySettings::Model::perez;
    CHECK_THROWS_AS(load_scene(file, settings), Error);
}
