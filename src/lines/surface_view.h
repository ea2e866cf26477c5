#pragma once

#include <algorithm>
#include <cstdint>

#include "parallux/lines.h"

namespace parallux {

/// A surface as one bundle sees it: (u, v) and depth as affine functions of column and row, and
/// what its two sides are called. Counted from a line near the surface, so that floats suffice.
struct SurfaceView {
    std::int32_t column = 0, row = 0;
    float u = 0, u_column = 0, u_row = 0;
    float v = 0, v_column = 0, v_row = 0;
    float depth = 0, depth_u = 0, depth_v = 0;
    float moved = 0;  ///< how far snapping may have moved a depth
    float slack = 0;  ///< from where on a step of depth is certain, shared with the other surface
    std::uint32_t surface = none;
    std::uint32_t toward = none, away = none;  // first patch of either side
    std::uint32_t nu = 1, nv = 1;
    Shape shape = Shape::parallelogram;
    const Projection::Ball* ball = nullptr;  ///< half of a sphere: (u, v) and depth are its roots
    bool far = false;                        ///< the half that lines meet last
};

/// The view of a surface of a projected scene.
SurfaceView view_of(const Projection& projection, const Scene& scene, const Patches& patches,
                    std::uint32_t surface);

/// Where on a surface a line meets it; snapping and rounding may leave the surface by a hair, so
/// that both stay within [0, 1].
struct Place {
    float u, v;
};
inline Place place_at(const SurfaceView& view, std::int32_t column, std::int32_t row) {
    float x = static_cast<float>(column - view.column), y = static_cast<float>(row - view.row);
    float u = view.u + (view.u_column * x + view.u_row * y);
    float v = view.v + (view.v_column * x + view.v_row * y);
    return {std::min(std::max(u, 0.0f), 1.0f), std::min(std::max(v, 0.0f), 1.0f)};
}

inline float depth_at(const SurfaceView& view, const Place& place) {
    return view.depth + (view.depth_u * place.u + view.depth_v * place.v);
}

/// The hit of a line on half of a sphere.
Hit ball_hit(const SurfaceView& view, std::int32_t column, std::int32_t row);

/// The hit of a line on a surface.
inline Hit hit_at(const SurfaceView& view, std::int32_t column, std::int32_t row) {
    if (view.ball)
        return ball_hit(view, column, row);
    Place place = place_at(view, column, row);
    std::uint32_t cell = 0;
    if (view.nu * view.nv > 1)
        cell = cell_at(view.shape, view.nu, view.nv, place.u, place.v);
    Hit hit;
    hit.depth = depth_at(view, place);
    hit.surface = view.surface;
    hit.toward = view.toward == none ? none : view.toward + cell;
    hit.away = view.away == none ? none : view.away + cell;
    return hit;
}

}  // namespace parallux
