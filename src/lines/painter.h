#pragma once

#include <cstdint>
#include <vector>

#include "lines/surface_view.h"
#include "lines/tile_bounds.h"
#include "parallux/lines.h"

namespace parallux {

/// Neighbouring lines of a row that are followed together.
inline constexpr std::int32_t block_lines = 16;

/// Lines of one block that meet a surface: bit k is line k.
struct BlockSpan {
    std::uint16_t view, lines;
};

/// What the blocks of a tile meet, surface by surface in their order.
class BlockLists {
public:
    static constexpr std::size_t most_views = 96;

    /// Empty lists of a tile, for so many surfaces.
    void reset(const TileBounds& bounds, std::size_t views);

    /// Columns begin … end - 1 of a row, from the tile's corner, meet a surface. Views come in
    /// their order.
    void add(std::uint16_t view, std::int32_t row, std::int32_t begin, std::int32_t end) {
        hits_ += static_cast<std::uint64_t>(end - begin);
        for (std::int32_t block = begin / block_lines; block * block_lines < end; ++block) {
            std::int32_t first = begin - block * block_lines, last = end - block * block_lines;
            std::uint32_t lines = last < block_lines ? (1u << last) - 1 : 0xffffu;
            if (first > 0)
                lines &= ~0u << first;
            append(static_cast<std::size_t>(row * blocks_ + block), view, lines);
        }
    }

    std::int32_t blocks() const { return blocks_; }  ///< in a row
    std::uint64_t hits() const { return hits_; }
    const BlockSpan* begin(std::size_t block) const { return &spans_[block * capacity_]; }
    const BlockSpan* end(std::size_t block) const { return begin(block) + count_[block]; }

private:
    void append(std::size_t block, std::uint16_t view, std::uint32_t lines) {
        BlockSpan* own = &spans_[block * capacity_];
        std::uint8_t& count = count_[block];
        // A surface that snapping has folded may have two runs in a row.
        if (count > 0 && own[count - 1].view == view)
            own[count - 1].lines |= static_cast<std::uint16_t>(lines);
        else
            own[count++] = {view, static_cast<std::uint16_t>(lines)};
    }

    std::int32_t blocks_ = 0;
    std::size_t capacity_ = 0;
    std::uint64_t hits_ = 0;
    std::vector<BlockSpan> spans_;  // block after block, capacity_ places each
    std::vector<std::uint8_t> count_;
};

/// Lines of a block whose order the depths leave open.
struct UnsureLines {
    std::size_t block;
    std::uint32_t lines;
};

/// Follows the lines of a tile through their surfaces in order, a block at a time: every surface's
/// patch is paired with the one that the line met last. Lines that meet a surface less than both
/// slacks beyond the last, or before it, are left out and handed back as unsure. Appends to
/// `pairs`, which must have room for all hits.
void paint(const SurfaceView* views, const BlockLists& lists, const TileBounds& bounds,
           TilePairs& pairs, std::vector<UnsureLines>& unsure);

}  // namespace parallux
