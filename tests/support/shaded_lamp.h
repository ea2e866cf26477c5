#pragma once

#include "support/hand_made.h"

namespace parallux::test {

// A lamp of a few centimetres within four white plates, under the ceiling of a room: less than a
// thousandth of a cell each.
inline Scene shaded_lamp() {
    Scene scene = room(grey(0.6), 4);
    scene.materials.push_back(grey(0.9, 0, true));
    scene.materials.push_back(grey(0.2, 100));
    scene.objects.push_back("lamp");
    constexpr double x = 0.31, y = 0.57, z = 0.81, side = 0.03, high = 0.04;
    auto add = [&](glm::dvec3 at, glm::dvec3 u, glm::dvec3 v, std::uint32_t material) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (const glm::dvec3& corner : {at, at + u, at + u + v, at + v})
            scene.positions.push_back(corner);
        Surface surface;
        surface.corner = {first, first + 1, first + 2, first + 3};
        surface.material = material;
        surface.object = 1;
        surface.grid_u = surface.grid_v = 1;
        scene.surfaces.push_back(surface);
    };
    const glm::dvec3 u(side, 0, 0), v(0, side, 0), w(0, 0, high);
    add({x, y, z + high}, v, u, 7);  // faces down
    add({x, y, z}, u, w, 6);
    add({x, y + side, z}, w, u, 6);
    add({x, y, z}, w, v, 6);
    add({x + side, y, z}, v, w, 6);
    return scene;
}

}  // namespace parallux::test
