#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "materials/shiny.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

constexpr double everywhere = 2;  // radiosity of all that is diffuse

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
    const Scene scene = room_of_shared_places();
    const Patches patches = make_patches(scene);
    for (FirstShot shot : {FirstShot::off, FirstShot::rays}) {
        CAPTURE(int(shot));
        SolveSettings settings;
        settings.bundles = 512;
        settings.first_shot = shot;
        const Solution solution = solve(scene, patches, settings);
        CAPTURE(double(solution.energy.escaped[0]) / double(solution.energy.emitted[0]));
        CHECK(solution.energy.escaped[0] <= solution.energy.emitted[0] / 100'000);
        settings.bundles = 256;
        const std::vector<Sample> samples = over_seeds(scene, patches, settings, 16);
        double worst = 0;
        std::size_t count = 0;
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const double diffuse = 1 - patches.specular_share(k);
            const double expected =
                patches.emission[k] + diffuse * everywhere * patches.reflectance[k];
            if (patches.reflectance[k] == 0 || samples[k].standard_error() == 0)
                continue;
            worst = std::max(worst, std::fabs(samples[k].z(expected)));
            ++count;
        }
        CHECK(count >= 24);
        CHECK(worst < sidak_bound(count, 16));
    }
}
