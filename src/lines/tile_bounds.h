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
    bounds.left =
        projection.left + static_cast<std::int32_t>(tile % projection.tiles_x) * tile_side;
    bounds.top = projection.top + static_cast<std::int32_t>(tile / projection.tiles_x) * tile_side;
    bounds.right = std::min(bounds.left + tile_side, projection.left + projection.columns);
    bounds.bottom = std::min(bounds.top + tile_side, projection.top + projection.rows);
    return bounds;
}

}  // namespace parallux
