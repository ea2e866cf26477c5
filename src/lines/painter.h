#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "lines/surface_view.h"
#include "parallux/lines.h"

namespace parallux {

/// A run of lines in one row of a tile that meet one surface; columns from the tile's corner.
struct RowSpan {
    std::uint32_t view;
    std::int32_t begin, end;
};

/// The lines of one row of a tile: what each met last.
struct RowState {
    static constexpr std::int32_t padded = tile_side + 16;
    static constexpr std::int32_t no_patch = -1;  ///< an inert back
    static constexpr std::int32_t outside = -2;   ///< nothing yet

    alignas(64) std::array<std::int32_t, padded> last;    ///< patch that looks along the direction
    alignas(64) std::array<float, padded> depth, slack;   ///< of the last hit
    alignas(64) std::array<std::int32_t, padded> odd;     ///< 1: an odd number of hits
    alignas(64) std::array<std::int32_t, padded> unsure;  ///< ≠ 0: the order is not certain

    /// Nothing met yet; `unsure` stays.
    void clear() {
        last.fill(outside);
        depth.fill(-std::numeric_limits<float>::infinity());
        slack.fill(0);
        odd.fill(0);
    }
};

/// Follows the spans of one row in their order, 16 lines at a time where the machine can: every
/// surface's patch is paired with the one that the line met last. Lines that meet a surface less
/// than both slacks beyond the last, or before it, are marked unsure; with `skip` such lines are
/// left out, and nothing is marked. `column`, `row`: of the tile's first line of this row. Returns
/// whether any line is unsure. Appends to `pairs`, which must have room for all hits.
bool paint_row(const SurfaceView* views, const RowSpan* spans, std::size_t count,
               std::int32_t column, std::int32_t row, std::int32_t columns, bool skip,
               RowState& state, TilePairs& pairs);

}  // namespace parallux
