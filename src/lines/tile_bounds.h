#pragma once

#include <algorithm>

#include "parallux/lines.h"

namespace parallux {

/// The lines of one tile: columns left … right - 1, rows top … bottom - 1 of the bundle.
struct TileBounds {
    std::int32_t left, top, right, bottom;

    std::int32_t columns() const { return right - left; }
    std::int32_t rows() const { return bottom - top; }
    std::size_t lines() const {
        return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
    }
};

inline TileBounds tile_bounds(const Projection& projection, std::size_t tile) {
    TileBounds bounds;
    std::int32_t x = static_cast<std::int32_t>(tile) % projection.tiles_x;
    std::int32_t y = static_cast<std::int32_t>(tile) / projection.tiles_x;
    bounds.left = projection.left + x * projection.tile_columns;
    bounds.top = projection.top + y * projection.tile_rows;
    bounds.right =
        std::min(bounds.left + projection.tile_columns, projection.left + projection.columns);
    bounds.bottom = std::min(bounds.top + projection.tile_rows, projection.top + projection.rows);
    return bounds;
}

}  // namespace parallux
