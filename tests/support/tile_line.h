#pragma once

#include <algorithm>

#include <glm/vec3.hpp>

#include "parallux/lines.h"

namespace parallux::test {

/// A line of a bundle, as a ray that begins outside of the scene's sphere.
struct TileLine {
    glm::dvec3 origin;
    double x, y;  ///< across, in spacings from the sphere's centre
};

/// The line of list `k` of a tile.
inline TileLine tile_line(const Projector& projector, const Projection& projection,
                          const Bundle& bundle, std::size_t tile, std::size_t k) {
    const std::int32_t left =
        projection.left + std::int32_t(tile % projection.tiles_x) * projection.tile_columns;
    const std::int32_t top =
        projection.top + std::int32_t(tile / projection.tiles_x) * projection.tile_rows;
    const std::int32_t columns =
        std::min(projection.tile_columns, projection.left + projection.columns - left);
    TileLine line;
    line.x = left + double(std::int32_t(k) % columns) - bundle.offset_x;
    line.y = top + double(std::int32_t(k) / columns) - bundle.offset_y;
    line.origin = projector.centre() + bundle.spacing * (line.x * bundle.x + line.y * bundle.y) -
                  2.0 * projector.radius() * bundle.direction;
    return line;
}

}  // namespace parallux::test
