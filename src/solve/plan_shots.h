#pragma once

#include "solve/plan.h"

namespace parallux {

/// Settles how direct light is found and with how many rays, and the rays of later shots and of
/// the methods that send nothing else. Takes the plan's lines.
void plan_shots(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                Plan& plan);

/// Whether the method casts single rays or lines, or has lights that do.
bool needs_rays(const Scene& scene, const Patches& patches, const SolveSettings& settings);

/// Sets the rays of a group's first shot so that direct light and lines take the time that lowers
/// the error most; `ray_variance`: relative quadratic error of direct light, times rays.
void set_rays(const Patches& patches, double ray_variance, Plan& plan);

}  // namespace parallux
