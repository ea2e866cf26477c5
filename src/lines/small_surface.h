#pragma once

#include <cstdint>

#include "lines/edge_walk.h"
#include "lines/hit_layers.h"

namespace parallux {

/// An edge of a small surface, seen from a line nearby: E(p) = (x1 - x0)(p_y - y0) - (y1 - y0)(p_x
/// - x0) in fixed point, which is positive within; less 1 where points of the edge itself belong to
/// the neighbour: a surface owns its edges on the left and above (fill_surface()'s half-open rows
/// and columns).
struct Edge {
    std::int32_t at, per_column, per_row;
};
inline Edge edge_of(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    const std::int32_t dx = x1 - x0, dy = y1 - y0;
    const bool own = dy < 0 || (dy == 0 && dx > 0);
    return {dy * x0 - dx * y0 - (own ? 0 : 1), -dy * static_cast<std::int32_t>(fixed_one),
            dx * static_cast<std::int32_t>(fixed_one)};
}

/// Blocks of 16 lines, for surfaces up to 4 and up to 8 lines wide.
struct BlockShape {
    std::int32_t width, height;
    std::uint32_t columns;  ///< lines of the first column
    alignas(64) std::int32_t x[16], y[16];
    alignas(64) std::int32_t line[16];  ///< from the block's first, in layers
};
constexpr BlockShape block_shape(std::int32_t width) {
    BlockShape shape{width, 16 / width, 0, {}, {}, {}};
    for (std::int32_t k = 0; k < 16; ++k) {
        shape.x[k] = k % width;
        shape.y[k] = k / width;
        shape.line[k] = shape.y[k] * HitLayers::side + shape.x[k];
        if (k % width == 0)
            shape.columns |= 1u << k;
    }
    return shape;
}
inline constexpr BlockShape square_block = block_shape(4), wide_block = block_shape(8);

/// By the blocks that they take: one or two square ones, one to four wide ones.
inline constexpr int block_classes = 6;

/// Surfaces no larger than this in either direction, in lines, fit the integers of a block.
inline constexpr std::int32_t small_extent = 7;

}  // namespace parallux
