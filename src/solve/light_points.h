#pragma once

#include "solve/first_shot.h"

namespace parallux {

/// Adds what point, spot and directional lights send straight to each patch: the mean over
/// stratified points of the patch, a shadow ray each. O(patches · lights), in parallel.
void add_light_points(const Scene& scene, const Patches& patches, const RayScene& rays,
                      const FirstShotSettings& settings, DirectLight& direct);

}  // namespace parallux
