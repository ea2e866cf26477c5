#pragma once

#include "solve/plan.h"

namespace parallux {

/// Settles the lines of a run: spacing, bundles, groups, how many gather and how many carry no new
/// emission, batches, and what an exit carries of the emission. Takes the plan's sphere.
void plan_lines(const Patches& patches, const SolveSettings& settings, Plan& plan);

/// Area of a patch in the mean, m².
double mean_area(const Patches& patches);

/// Mean by area, over all bands.
double mean_reflectance(const Patches& patches);

}  // namespace parallux
