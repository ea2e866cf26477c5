#pragma once

#include "lines/edge_walk.h"
#include "parallux/lines.h"

namespace parallux {

/// Puts right what rounding may have turned: hits of one line that lie closer together than the
/// snapping could move them are ordered again. Faces that share a corner by the exact depth of
/// their snapped corners, in which two faces meet along their common edge; others, which then lie
/// in one place, so that the one met from behind comes first (a solid that stands on a floor: the
/// gap is between them). `begin` … `end` are sorted by depth, then surface; `slack[surface]` is how
/// far snapping may have moved the depths of each.
void order_near_ties(const Projection& projection, const Scene& scene, const Patches& patches,
                     const glm::dvec3& centre, double radius, std::int32_t column, std::int32_t row,
                     const std::vector<float>& slack, Hit* begin, Hit* end);

/// Whether two surfaces share a corner.
inline bool touch(const Surface& a, const Surface& b) {
    for (std::uint32_t k : a.corner)
        for (std::uint32_t l : b.corner)
            if (k == l && k != none)
                return true;
    return false;
}

/// Surfaces without a common corner whose depths differ by less than this, in radii, lie in one
/// place: no more than their corners' snapping, at slopes to 16.
inline float same_place(const Projection& projection) {
    return static_cast<float>(16 * projection.bundle.spacing / projection.radius / fixed_one);
}

/// Depths closer than this, in radii, are near ties: an eighth of a line spacing.
inline float near_tie(double spacing, double radius) {
    return static_cast<float>(0.125 * spacing / radius);
}

}  // namespace parallux
