#pragma once

#include "parallux/solve.h"
#include "support/hand_made.h"

// Scenes that a surface parts which lets light through.

namespace parallux::test {

/// Two-sided; the back as the front.
inline Material leaf(double reflectance, double transmittance, double emission = 0) {
    Material material = grey(reflectance, emission, true);
    material.name = "leaf";
    material.transmittance = Spectrum::constant(static_cast<float>(transmittance));
    return material;
}

/// Two-sided, each side with its own values.
inline Material leaf(double reflectance, double transmittance, double back_reflectance,
                     double back_transmittance, double emission) {
    Material material = leaf(reflectance, transmittance, emission);
    material.own_back = true;
    material.back_reflectance = Spectrum::constant(static_cast<float>(back_reflectance));
    material.back_transmittance = Spectrum::constant(static_cast<float>(back_transmittance));
    return material;
}

/// Unit cubes one upon the other, of `lower` and `upper` walls: the first six and the last six
/// surfaces are theirs but for the floor and ceiling between them, which one plate takes, its front
/// up. `lamp` replaces the lower floor and, of less power, the upper ceiling where it emits.
inline Scene chambers(const Material& lower, const Material& upper, const Material& plate,
                      std::uint32_t n, const Material& lamp = {}) {
    Scene scene = room(lower, n);
    Scene above = room(upper, n, {0, 0, 1}, {1, 1, 2});
    scene.surfaces.pop_back();  // z+ of the lower one
    for (Surface surface : above.surfaces) {
        for (std::uint32_t& corner : surface.corner)
            corner += 8;
        surface.material += 6;
        scene.surfaces.push_back(surface);
    }
    scene.positions.insert(scene.positions.end(), above.positions.begin(), above.positions.end());
    scene.materials.insert(scene.materials.end(), above.materials.begin(), above.materials.end());
    scene.materials.push_back(plate);
    scene.surfaces[9].material = 12;  // z- of the upper one
    if (lamp.emission != Spectrum{}) {
        scene.materials.push_back(lamp);
        scene.surfaces[4].material = 13;
    }
    return scene;
}

}  // namespace parallux::test
