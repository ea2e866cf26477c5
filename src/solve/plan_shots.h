#pragma once

#include <string>

#include "solve/plan.h"

namespace parallux {

/// Settles how direct light is found and with how many rays, and the rays of later shots and of
/// the methods that send nothing else. Takes the plan's lines, and what its trial has told.
void plan_shots(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                Plan& plan);

/// One line where direct light is not found as was asked for; else nothing.
std::string shot_warning(const Scene& scene, const SolveSettings& settings);

/// Whether the method casts single rays or lines, or has lights that do.
bool needs_rays(const Scene& scene, const Patches& patches, const SolveSettings& settings);

}  // namespace parallux
