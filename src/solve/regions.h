#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"

namespace parallux {

/// The patches of a scene in so many regions that lines enough leave each. A patch that is large
/// enough is a region of its own; the others are joined where they belong to one object and side,
/// face one way and lie in one cube of a grid, as fine as the wanted number allows.
struct Regions {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> of;     ///< one a patch
    std::vector<std::uint32_t> sizes;  ///< patches of each
    std::vector<std::uint32_t> group;  ///< of each: one of few groups, joined in the same manner
    std::uint32_t groups = 0;
};

/// About `wanted` regions in `groups` groups, or fewer. The smallest of very many objects are
/// joined with each other. O(n log n) in the patches.
Regions make_regions(const Scene& scene, const Patches& patches, std::size_t wanted,
                     std::size_t groups);

}  // namespace parallux
