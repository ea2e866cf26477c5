#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "materials/furnace.h"
#include "materials/shiny.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// Mirrors in part, and emits so that all it sends is what arrives.
Material half_mirror(bool two_sided) {
    Material material = mirror(0.75, 0, 0.5, 0.5);
    material.two_sided = two_sided;
    return emitting(material, (1 - 0.5 * 0.75 - 0.5 * 0.5) * everywhere);
}

// Adds the other face of what was last added, of a material of its own.
void add_other_face(Scene& scene, const Material& material) {
    Surface face = scene.surfaces.back();
    std::swap(face.corner[1], face.corner[3]);
    face.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.surfaces.push_back(face);
}

// A closed room of one radiosity. Mirrors lie on its walls and over each other, glass stands on its
// floor, sheets of two one-sided faces hang in it.
Scene room_of_shared_places() {
    Scene scene = room(grey(0.5, 0.5 * everywhere), 2);
    add_plate(scene, {0.1, 0.1, 0}, {0.5, 0, 0}, {0, 0.5, 0}, half_mirror(true), 2);
    add_plate(scene, {0.4, 0.4, 0}, {0.4, 0, 0}, {0, 0.4, 0}, half_mirror(true), 2);
    add_plate(scene, {0, 0.2, 0.2}, {0, 0.6, 0}, {0, 0, 0.6}, half_mirror(true), 2);
    add_block(scene, {0.65, 0.1, 0}, {0.9, 0.35, 0.3}, glass(1.5));
    add_plate(scene, {0.3, 0.31, 0.6}, {0.4, 0, 0.1}, {0, 0.37, 0.05}, half_mirror(false));
    add_other_face(scene, half_mirror(false));
    add_plate(scene, {0.2, 0.61, 0.4}, {0.3, 0.1, 0}, {0, 0.05, 0.3}, half_mirror(false));
    add_other_face(scene, grey(0.5, 0.5 * everywhere));
    // Of what looks the same way the first of the scene lies in front.
    std::rotate(scene.surfaces.begin(), scene.surfaces.begin() + 6, scene.surfaces.end());
    return scene;
}

}  // namespace

// Planted, seen to fail: tests/planted/shiny_beside.patch.
TEST_CASE("mirrors and glass that share a place with something let no light out of a room") {
    check_furnace(room_of_shared_places(), 1e-5, true);
}
