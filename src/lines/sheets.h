#pragma once

#include <memory>
#include <vector>

#include "parallux/scene.h"

namespace parallux {

/// Whether two surfaces are the two faces of a sheet: the same corners, turned the other way.
bool are_sheet(const Scene& scene, const Surface& a, const Surface& b);

/// Which surfaces are a face of a sheet, as files have for leaves and cloth in place of two-sided
/// materials. A line enters a sheet as it does a solid, by the face that it meets from its front.
/// O(n log n).
std::shared_ptr<const std::vector<bool>> sheet_faces(const Scene& scene);

/// The order of surfaces in one place, smaller first: what is met from behind, then sheets, then
/// what is met from its front, since the air lies between a floor and what stands on it.
inline int place_rank(bool from_behind, bool sheet) {
    return sheet ? (from_behind ? 2 : 1) : (from_behind ? 0 : 3);
}

}  // namespace parallux
