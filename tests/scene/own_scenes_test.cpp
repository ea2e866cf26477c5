#include <cmath>

#include <glm/geometric.hpp>

#include "scene_files.h"

using namespace parallux;

namespace {

Scene own(const std::string& name) {
    return load_scene(std::filesystem::path(PARALLUX_SCENES) / name);
}

std::uint64_t stated_cells(const Scene& scene) {
    std::uint64_t n = 0;
    for (const Surface& s : scene.surfaces)
        n += std::uint64_t(s.grid_u) * s.grid_v;
    return n;
}

}  // namespace

// Fails when corners are not snapped: thirds then leave gaps of one bit between the patches.
TEST_CASE("closed scenes are closed") {
    for (const char* name : {"paper_scene1_6.json", "paper_scene1_54.json", "paper_scene1_600.json",
                             "paper_scene2_114.json", "paper_scene2_456.json",
                             "paper_scene2_1824.json", "paper_scene3.json", "paper_12150.json",
                             "furnace.json", "l_room.json", "naive_rule.json"}) {
        CAPTURE(name);
        Scene scene = own(name);
        CHECK(is_closed(scene));
        CHECK(scene.zero_area == 0);
        CHECK_FALSE(scene.cameras.empty());
    }
    CHECK_FALSE(is_closed(own("cornell_box.gltf")));
    CHECK_FALSE(is_closed(own("street_canyon.json")));
}

// Fails when a grid is read for one face of a box only, or u and v are mixed up with a count.
TEST_CASE("the paper's scenes have its patches and its power") {
    struct Case {
        const char* name;
        std::uint64_t patches;
        double area;
    };
    for (const Case& c :
         {Case{"paper_scene1_6.json", 6, 6}, Case{"paper_scene1_54.json", 54, 6},
          Case{"paper_scene1_600.json", 600, 6}, Case{"paper_scene2_114.json", 114, 7},
          Case{"paper_scene2_456.json", 456, 7}, Case{"paper_scene2_1824.json", 1824, 7},
          Case{"paper_scene3.json", 54, 6}, Case{"paper_12150.json", 12150, 7}}) {
        CAPTURE(c.name);
        Scene scene = own(c.name);
        CHECK(stated_cells(scene) == c.patches);
        CHECK(total_area(scene) == doctest::Approx(c.area).epsilon(1e-12));
        CHECK(scene.line_sphere == 0.9);
        double power = 0;
        for (std::uint32_t i = 0; i < scene.surfaces.size(); ++i) {
            CHECK(surface_reflectance(scene, i, 0.5, 0.5)[0] == 0.5f);
            power += surface_area(scene, scene.surfaces[i]) *
                     double(surface_emission(scene, i, 0.5, 0.5)[0]);
        }
        CHECK(power == doctest::Approx(1));
    }
}

// Fails when a box's faces turn the wrong way or `inward` is ignored.
TEST_CASE("fronts of rooms face in, those of blocks face out") {
    Scene scene = own("furnace.json");
    std::vector<glm::dvec3> centre(3, glm::dvec3(0));
    for (const Surface& s : scene.surfaces)
        centre[s.object] += surface_point(scene, s, 0.5, 0.5) / 6.0;
    for (const Surface& s : scene.surfaces) {
        double outward = glm::dot(surface_normal(scene, s),
                                  surface_point(scene, s, 0.5, 0.5) - centre[s.object]);
        CHECK((s.object == 0 ? outward < 0 : outward > 0));
    }
}

// Fails when the camera is turned the wrong way, or emission loses π or strength.
TEST_CASE("the Cornell box is the published one") {
    Scene scene = own("cornell_box.gltf");
    CHECK(scene.triangles == 36);
    REQUIRE(scene.cameras.size() == 1);
    CHECK(glm::distance(scene.cameras[0].forward, glm::dvec3(0, 0, 1)) < 1e-12);
    CHECK(glm::distance(scene.cameras[0].up, glm::dvec3(0, 1, 0)) < 1e-12);
    CHECK(scene.cameras[0].vertical_fov == doctest::Approx(2 * std::atan(0.0125 / 0.035)));
    Bounds b = scene_bounds(scene);
    CHECK(glm::distance(b.high, glm::dvec3(0.556, 0.5488, 0.5592)) < 1e-7);
    int lights = 0;
    for (std::uint32_t i = 0; i < scene.surfaces.size(); ++i) {
        const Surface& s = scene.surfaces[i];
        CHECK_FALSE(scene.materials[s.material].two_sided);
        glm::dvec3 normal = surface_normal(scene, s);
        if (scene.objects[s.object] == "floor")
            CHECK(normal.y == doctest::Approx(1));
        if (scene.objects[s.object] != "light")
            continue;
        ++lights;
        CHECK(normal.y == doctest::Approx(-1));
        CHECK(surface_area(scene, s) == doctest::Approx(0.13 * 0.105).epsilon(1e-5));
        Spectrum e = surface_emission(scene, i, 0.5, 0.5);
        CHECK(e[0] == doctest::Approx(17 * pi).epsilon(1e-5));
        CHECK(e[1] == doctest::Approx(12 * pi).epsilon(1e-5));
        CHECK(e[2] == doctest::Approx(4 * pi).epsilon(1e-5));
    }
    CHECK(lights == 1);
}
