#pragma once

#include "parallux/factors.h"

namespace parallux {

/// Groups of the run: none without a bundle of its own.
std::uint32_t choose_groups(const FactorSettings& settings);

/// δ. The error of directions falls as the bundles D of a lattice, that of places as the root of D
/// and with the lines a patch, which cost time: in a city these grow best as the third root of D.
double choose_spacing(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                      std::uint32_t groups);

}  // namespace parallux
