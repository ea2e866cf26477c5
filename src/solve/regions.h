#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"

namespace parallux {

/// The patches of a scene in some hundred regions: those of one object and way they face, in one of
/// the cubes that the scene's bounds are cut into. What encloses light by itself (a lamp, a
/// cupboard) and is small is a region of its own, inside apart from outside.
struct Regions {
    static constexpr std::uint32_t most = 255;

    std::uint32_t count = 0;
    std::vector<std::uint8_t> of;  ///< one a patch
};

/// O(patches + surfaces).
Regions make_regions(const Scene& scene, const Patches& patches);

}  // namespace parallux
