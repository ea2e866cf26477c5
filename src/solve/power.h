#pragma once

#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux {

/// The largest radiance of a sky in one band.
double sky_bound(const Sky& sky, std::uint32_t band);

/// Power that could enter or be emitted, of the band with most, from above; W.
double power_bound(const Scene& scene, const Patches& patches, const LineSphere& sphere);

/// Watts of a quantum: a power of two, so that scaling the light or the scene by one changes no bit
/// of the result. All that ever flows, at most P / (1 - ρ), fits 2⁶⁰ of them.
double quantum(double power, double highest_reflectance);

}  // namespace parallux
