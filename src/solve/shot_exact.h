#pragma once

#include <cstdint>
#include <vector>

#include "solve/emitters.h"
#include "solve/run.h"

namespace parallux {

/// Sends the power of the emitters by exact form factors: in closed form where nothing stands
/// between (rectangles, and convex polygons by contour integration), times the visible share of the
/// kernel over 1024 pairs of points where shadow rays find something between. Adds to the banks,
/// and to the totals of what was emitted and escaped; all that is emitted is received or escapes,
/// to the last quantum. Cells of one surface that emit alike are one emitter. O(emitters ·
/// patches), in parallel.
void shoot_exact(const Run& run, const Emitters& emitters, std::vector<std::int64_t>& emitted,
                 std::vector<std::int64_t>& escaped);

}  // namespace parallux
