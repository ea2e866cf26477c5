#pragma once

#include "solve/direct_light.h"
#include "solve/emitters.h"
#include "solve/run.h"

namespace parallux {

/// Sends the power of the emitters by exact form factors: in closed form where nothing stands
/// between (rectangles, and convex polygons by contour integration), times the visible share of the
/// kernel over 1024 pairs of points where shadow rays find something between. Adds to received,
/// emitted and escaped; all that is emitted is received or escapes, to the last quantum. Cells of
/// one surface that emit alike are one emitter. O(emitters · patches), in parallel.
void shoot_exact(const Run& run, const Emitters& emitters, DirectLight& direct);

}  // namespace parallux
