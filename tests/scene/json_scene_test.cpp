#include <cmath>

#include <glm/geometric.hpp>

#include "scene_files.h"

using namespace parallux;

namespace {

const std::string square =
    R"({"parallelogram": [[0,0,0],[2,0,0],[0,3,0]], "material": "m", "grid": [4, 5], "name": "s"})";
const std::string material = R"({"name": "m", "reflectance": 0.25, "emission": 2})";

// A scene with one material and one surface, and what else is given.
std::string scene(const std::string& more = "", const std::string& materials = material,
                  const std::string& surfaces = square) {
    return R"({"parallux": 1, "materials": [)" + materials + R"(], "surfaces": [)" + surfaces +
           "]" + more + "}";
}

}  // namespace

// Fails when a key is read under another name or unit.
TEST_CASE("a Parallux scene says what it says") {
    TestFolder folder;
    Scene s = load_scene(folder.write(
        "a.json", scene(R"(, "bands": 2, "scale": 0.5, "line_sphere": 3, "up": [0, 2, 0],
            "sky": {"gradient": {"zenith": [1, 2], "horizon": 3}},
            "lights": [{"type": "spot", "position": [2, 0, 0], "direction": [0, 0, 3],
                        "intensity": [5, 6], "inner_cone": 10, "outer_cone": 20, "range": 8}],
            "cameras": [{"name": "c", "eye": [0, 0, 4], "target": [0, 0, 0], "fov": 90,
                         "aspect": 2, "orthographic_height": 6}])")));
    CHECK(s.bands == 2);
    REQUIRE(s.surfaces.size() == 1);
    CHECK(surface_area(s, s.surfaces[0]) == 1.5);
    CHECK(s.surfaces[0].grid_u == 4);
    CHECK(s.surfaces[0].grid_v == 5);
    CHECK(s.objects[0] == "s");
    CHECK(surface_reflectance(s, 0, 0, 0)[1] == 0.25f);
    CHECK(surface_emission(s, 0, 0, 0)[0] == 2);
    CHECK(surface_emission(s, 0, 0, 0)[2] == 0);
    CHECK(s.line_sphere == 1.5);
    CHECK(s.sky.up == glm::dvec3(0, 1, 0));
    CHECK(s.sky.radiance({0, 1, 0})[1] == 2);
    REQUIRE(s.lights.size() == 1);
    CHECK(s.lights[0].position.x == 1);
    CHECK(s.lights[0].direction.z == 1);
    CHECK(s.lights[0].intensity[1] == 6);
    CHECK(s.lights[0].outer_cone == doctest::Approx(pi / 9));
    CHECK(s.lights[0].range == 4);
    REQUIRE(s.cameras.size() == 1);
    CHECK(s.cameras[0].position.z == 2);
    CHECK(s.cameras[0].forward.z == -1);
    CHECK(s.cameras[0].up.y == 1);
    CHECK(s.cameras[0].vertical_fov == doctest::Approx(pi / 2));
    CHECK(s.cameras[0].orthographic_height == 3);
}

// Fails when a check is removed, or its message no longer says where.
TEST_CASE("mistakes are named with their place") {
    TestFolder folder;
    auto fault = [&](const std::string& text) { return fault_of(folder.write("x.json", text)); };
    auto with = [&](const std::string& surface) { return scene("", material, surface); };
    CHECK(fault(scene()) == "");
    CHECK(holds(fault(scene(R"(, "colour": 1)")), "/colour: unknown key"));
    CHECK(holds(fault(scene("", R"({"name": "m", "reflectance": 1})")),
                "/materials/0/reflectance: must be less than 1"));
    CHECK(holds(fault(scene("", R"({"name": "m", "reflectance": -0.1})")),
                "/materials/0/reflectance: -0.1 is outside"));
    CHECK(holds(fault(scene("", R"({"name": "m", "reflectance": [0.1, 0.2]})")),
                "/materials/0/reflectance: must be a number or have one for each of the 3 bands"));
    CHECK(holds(fault(scene("", R"({"name": "m", "emission": -1})")), "/materials/0/emission"));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1,0,0],[0,1,0]], "material": "foo"})")),
                "x.json: /surfaces/0/material: no material \"foo\""));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1,0,0],[0,1,0]], "material": 1})")),
                "/surfaces/0/material: no material 1"));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1,0],[0,1,0]], "material": 0})")),
                "/surfaces/0/triangle/1: must have three numbers"));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1e16,0,0],[0,1,0]], "material": 0})")),
                "/surfaces/0/triangle/1/0: 1e+16 is outside"));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1,0,0],[0,1,0]], "grid": [2,3]})")),
                "/surfaces/0/grid"));
    CHECK(holds(fault(with(R"({"box": {"low": [0,0,0], "high": [1,1,0]}, "material": 0})")),
                "/surfaces/0/box: low must be less"));
    CHECK(holds(fault(with(R"({"triangle": [[0,0,0],[1,0,0],[2,0,0]]})")), "nothing with area"));
    CHECK(holds(fault(scene(R"(, "bands": 9)")), "/bands"));
    CHECK(holds(fault(scene(R"(, "parallux": 2)")), "/parallux"));
    CHECK(holds(fault(scene(R"(, "sky": {"uniform": 1, "image": "a.exr"})")), "/sky"));
    CHECK(holds(fault(scene(R"(, "cameras": [{"eye": [0,0,1], "target": [0,0,0]}])")),
                "/cameras/0: looks along its up"));
    CHECK(holds(fault("{\"parallux\": 1,"), "not valid JSON"));
    CHECK(holds(fault("{}"), "neither a Parallux scene"));
    CHECK(holds(fault(std::string(300, '[')), "nested deeper than 256"));
}

// Fails when paths are not held below the scene's folder.
TEST_CASE("nothing outside the scene's folder is read") {
    TestFolder folder;
    folder.write("out.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("in/in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::filesystem::create_symlink("../out.obj", folder.path() / "in" / "link.obj");
    auto fault = [&](const std::string& uri) {
        return fault_of(folder.write("in/x.json",
                                     R"({"parallux": 1, "meshes": [{"file": ")" + uri + R"("}]})"));
    };
    CHECK(fault("in.obj") == "");
    CHECK(fault("./%69n.obj") == "");
    CHECK(holds(fault("../out.obj"), "/meshes/0/file"));
    CHECK(holds(fault("%2e%2e/out.obj"), "leads out of the scene's folder"));
    CHECK(holds(fault("..\\\\out.obj"), "leads out of the scene's folder"));
    CHECK(holds(fault("link.obj"), "through a link"));
    CHECK(holds(fault((folder.path() / "in/in.obj").string()), "absolute"));
    CHECK(holds(fault("file:///etc/passwd.obj"), "not a relative path"));
    CHECK(holds(fault("missing.obj"), "no such file"));
    CHECK(holds(fault("x.json"), "/meshes/0/file: must be a"));
}

// Fails when an included mesh keeps its own scale, place or material numbers.
TEST_CASE("included meshes are placed and joined to the scene") {
    TestFolder folder;
    folder.write("m.mtl", "newmtl red\nKd 0.5 0.1 0.1\n");
    folder.write("m.obj",
                 "mtllib m.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    Scene s = load_scene(folder.write(
        "x.json", scene(R"(, "meshes": [{"file": "m.obj", "scale": 2, "translate": [0, 0, 5]},
                                        {"file": "m.obj", "material": "m"}])")));
    REQUIRE(s.surfaces.size() == 3);
    CHECK(surface_area(s, s.surfaces[1]) == 4);
    CHECK(surface_point(s, s.surfaces[1], 0, 0).z == 5);
    CHECK(surface_reflectance(s, 1, 0, 0)[1] == 0.1f);
    CHECK(surface_reflectance(s, 2, 0, 0)[1] == 0.25f);
    std::string fault =
        fault_of(folder.write("y.json", scene(R"(, "bands": 1, "meshes": [{"file": "m.obj"}])")));
    CHECK(holds(fault, "/meshes/0: a mesh's own materials have three bands"));
}
