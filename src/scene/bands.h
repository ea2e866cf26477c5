#pragma once

#include <vector>

#include "parallux/scene.h"

namespace parallux {

/// Which materials still have the scene's own values, one entry a material.
struct ValuesKept {
    std::vector<bool> reflectance, emission, transmittance, back_reflectance, back_transmittance;
};

/// Makes a scene one of so many bands: what is kept of its values, its lights and its sky must have
/// one value in all bands it had, unless the number stays. Throws Fault::input naming what has not.
void spread_bands(Scene& scene, std::uint32_t bands, const ValuesKept& kept);

}  // namespace parallux
