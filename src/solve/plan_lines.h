#pragma once

#include "solve/plan.h"

namespace parallux {

/// Bundles from which on a run states its error: eight groups of 100. Measured in
/// rooms of unequal walls at reflectances of 0.2 to 0.99: their bias is about a tenth of that
/// error.
inline constexpr std::uint64_t bundles_for_error = 800;

/// Settles the lines of a run: spacing, bundles, groups, how many gather and how many carry no new
/// emission, batches, and what an exit carries of the emission. Takes the plan's sphere.
void plan_lines(const Patches& patches, const SolveSettings& settings, Plan& plan);

/// Area of a patch in the mean, m².
double mean_area(const Patches& patches);

/// The area below which patches are for local rays to serve, rather than lines, m².
double too_small(const Patches& patches);

/// Mean by area, over all bands.
double mean_reflectance(const Patches& patches);

}  // namespace parallux
