#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lines/rectangle.h"
#include "lines/surface_view.h"
#include "lines/tile_bounds.h"
#include "parallux/lines.h"

// Whole spheres in a bundle. Seen along lines a sphere is a disc, and its halves have the same
// lines by the same arithmetic: whatever that rounds, every line meets both or none. Depths and
// places are the roots of its equation, for many lines at once in ball_hits-inl.h.

namespace parallux {

/// The lines of one row that meet a sphere, and how far (in spacings) the first lies within its
/// left end, the last within its right one.
struct BallRow {
    std::int32_t begin = 0, end = 0;
    float before = 0, beyond = 0;
};

inline BallRow row_of(const Projection::Ball& ball, std::int32_t row) {
    const double y = row - ball.y, square = ball.radius * ball.radius - y * y;
    if (!(square > 0))
        return {};
    const double half = std::sqrt(square), left = ball.x - half, right = ball.x + half;
    const double begin = std::ceil(left), end = std::ceil(right);
    return {static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end),
            static_cast<float>(begin - left), static_cast<float>(right - (end - 1))};
}

/// emit(row, first column, end column) of the rows of a tile, as fill_surface().
template <class Emit>
void fill_ball(const Projection::Ball& ball, const TileBounds& tile, Emit&& emit) {
    const Rectangle box = ball_rectangle(ball);
    const std::int32_t stop = std::min(tile.bottom, box.bottom);
    for (std::int32_t row = std::max(tile.top, box.top); row < stop; ++row) {
        const BallRow lines = row_of(ball, row);
        const std::int32_t begin = std::max(lines.begin, tile.left);
        const std::int32_t end = std::min(lines.end, tile.right);
        if (begin < end)
            emit(row, begin, end);
    }
}

/// The depth of one half at a line, by doubles, in radii of the scene.
inline double ball_depth(const Projection::Ball& ball, bool far, std::int32_t column,
                         std::int32_t row) {
    const double x = column - ball.x, y = row - ball.y;
    const double half = std::sqrt(std::max(0.0, ball.radius * ball.radius - x * x - y * y));
    return ball.depth + (far ? half : -half) * ball.per_spacing;
}

/// A bundle's spheres, one a curve of the scene, about the centre that depths count from.
void project_balls(const Bundle& bundle, const Scene& scene, const glm::dvec3& centre,
                   Projection& projection);

/// The view of one half.
SurfaceView ball_view(const Projection& projection, const Scene& scene, const Patches& patches,
                      std::uint32_t surface);

}  // namespace parallux
