#pragma once

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

/// Adds what point, spot and directional lights send straight to each patch: the mean over
/// stratified points of the patch, a shadow ray each. O(patches · lights), in parallel.
void add_light_points(const Run& run, DirectLight& direct);

}  // namespace parallux
