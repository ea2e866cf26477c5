#pragma once

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

/// Adds what point, spot and directional lights send straight to each patch: the mean over
/// 4 × 4 points of each cell, a shadow ray each, four over the disc of a light that has one. The
/// points are the same in every run, so that shadows' edges are off by up to about a sixteenth of a
/// cell, which no error bar shows. O(patches · lights), in parallel.
void add_light_points(const Run& run, DirectLight& direct);

}  // namespace parallux
