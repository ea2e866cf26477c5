#include <cmath>

#include <doctest/doctest.h>

#include "hand_made.h"
#include "parallux/error.h"
#include "parallux/picture.h"

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

// Planted error: the index tried before the name, so that a camera named "0" is not found.
TEST_CASE("a camera is found by name, else by index, else the first") {
    Scene scene;
    for (const char* name : {"door", "0", "window"}) {
        Camera camera;
        camera.name = name;
        scene.cameras.push_back(camera);
    }
    CHECK(choose_camera(scene, "").name == "door");
    CHECK(choose_camera(scene, "0").name == "0");
    CHECK(choose_camera(scene, "2").name == "window");
    for (const char* wrong : {"3", "-1", "roof", "1x", "99999999999999999999999"})
        try {
            choose_camera(scene, wrong);
            FAIL("found ", wrong);
        } catch (const Error& error) {
            CHECK(error.fault() == Fault::usage);
            CHECK(std::string(error.what()).find("window") != std::string::npos);
        }
}

// Planted errors: y up for .json; the camera left in the middle; culled backs counted as walls.
TEST_CASE("without a camera, one stands in a closed room and looks along it") {
    Case c;
    c.scene.file = "room.json";
    c.material(Spectrum::constant(0.5f));
    dvec3 s(3, 6, 2.5), x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
    c.quad({0, 0, 0}, x, y, 1, 1), c.quad(s, -y, -x, 1, 1);
    c.quad({0, 0, 0}, z, x, 1, 1), c.quad(s, -x, -z, 1, 1);
    c.quad({0, 0, 0}, y, z, 1, 1), c.quad(s, -z, -y, 1, 1);
    Camera camera = choose_camera(c.scene, "");
    CHECK(camera.position.x == doctest::Approx(1.5));
    CHECK(camera.position.y == doctest::Approx(0.3));
    CHECK(camera.position.z == doctest::Approx(0.55 * 2.5));
    CHECK(camera.forward.y > 0.9);
    CHECK(camera.forward.z < 0);
    CHECK(glm::dot(camera.forward, camera.up) == doctest::Approx(0));
    CHECK(glm::length(camera.up) == doctest::Approx(1));
}

// Planted error: a distance for the bounds' side instead of their diagonal.
TEST_CASE("without a camera, a box is seen whole from outside and above") {
    Case c;
    c.scene.file = "box.obj";
    c.material(Spectrum::constant(0.5f));
    c.box({5, 5, 5}, {1, 2, 3}, 1);
    Camera camera = choose_camera(c.scene, "");
    CHECK(camera.position.y > 7);
    CHECK(camera.up.y > 0.7);
    for (const dvec3& corner : c.scene.positions) {
        dvec3 way = glm::normalize(corner - camera.position);
        CHECK(std::acos(glm::dot(way, camera.forward)) < 0.5 * camera.vertical_fov);
    }
}
