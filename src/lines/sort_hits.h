#pragma once

#include <algorithm>
#include <vector>

#include "parallux/lines.h"

namespace parallux {

/// The order of hits on a line: by depth, ties by surface.
inline bool before(const Hit& a, const Hit& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.surface < b.surface;
}

/// Sorts a list. Returns whether any two hits are so near each other that snapping and rounding may
/// have turned them; `slack[surface]` is how far snapping may have moved the depths of each.
inline bool sort_hits(Hit* begin, Hit* end, float tie, const std::vector<float>& slack) {
    if (end - begin < 2)
        return false;
    // Lists are mostly 2 to 4 long.
    if (end - begin > 24) {
        std::sort(begin, end, before);
    } else {
        for (Hit* k = begin + 1; k < end; ++k) {
            Hit hit = *k;
            Hit* place = k;
            for (; place > begin && before(hit, place[-1]); --place)
                *place = place[-1];
            *place = hit;
        }
    }
    for (Hit* k = begin + 1; k < end; ++k) {
        float step = k->depth - k[-1].depth;
        if (step < tie || step < slack[k->surface] + slack[k[-1].surface])
            return true;
    }
    return false;
}

}  // namespace parallux
