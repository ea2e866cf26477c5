#include "lines/surface_view.h"

#include <cmath>

#include "lines/ball.h"
#include "lines/depth_order.h"
#include "lines/edge_walk.h"

namespace parallux {

// Solves for (u, v) at a line: with the projected axes e_u, e_v and p from the origin corner,
// u = (p × e_v) / (e_u × e_v), v = (e_u × p) / (e_u × e_v). A surface seen exactly from its edge
// covers no line; its inverse is set to 0 to keep numbers finite.
SurfaceView view_of(const Projection& projection, const Scene& scene, const Patches& patches,
                    std::uint32_t s) {
    const Surface& surface = scene.surfaces[s];
    if (surface.is_curved())
        return ball_view(projection, scene, patches, s);
    const Projection::Corner& origin = projection.corners[surface.corner[0]];
    const Projection::Corner& end_u = projection.corners[surface.corner[1]];
    const Projection::Corner& end_v = projection.corners[surface.corner_v()];
    constexpr double unit = 1.0 / fixed_one;
    double ux = (static_cast<double>(end_u.x) - origin.x) * unit;
    double uy = (static_cast<double>(end_u.y) - origin.y) * unit;
    double vx = (static_cast<double>(end_v.x) - origin.x) * unit;
    double vy = (static_cast<double>(end_v.y) - origin.y) * unit;
    double turned = ux * vy - uy * vx;
    double inverse = turned != 0 ? 1 / turned : 0;

    SurfaceView view;
    view.column = origin.x >> fixed_bits;
    view.row = origin.y >> fixed_bits;
    double px = view.column - origin.x * unit, py = view.row - origin.y * unit;
    view.u = static_cast<float>((px * vy - py * vx) * inverse);
    view.u_column = static_cast<float>(vy * inverse);
    view.u_row = static_cast<float>(-vx * inverse);
    view.v = static_cast<float>((ux * py - uy * px) * inverse);
    view.v_column = static_cast<float>(-uy * inverse);
    view.v_row = static_cast<float>(ux * inverse);
    view.depth = origin.depth;
    view.depth_u = end_u.depth - origin.depth;
    view.depth_v = end_v.depth - origin.depth;
    // Corners move by half a fixed place in either axis at most; twice that. For certainty also
    // rounding, and half of what order_near_ties() takes for one place.
    float per_column = view.depth_u * view.u_column + view.depth_v * view.v_column;
    float per_row = view.depth_u * view.u_row + view.depth_v * view.v_row;
    view.moved = (std::fabs(per_column) + std::fabs(per_row)) / static_cast<float>(fixed_one);
    view.slack =
        std::max(view.moved + 4e-6f * (std::fabs(view.depth_u) + std::fabs(view.depth_v)) + 1e-6f,
                 0.51f * same_place(projection));
    view.surface = s;
    // The front's normal points along the direction when its corners turn from x to y: then the
    // traveller comes upon the back.
    const SurfaceGrid& grid = patches.grids[s];
    view.toward = turned > 0 ? grid.back : grid.front;
    view.away = turned > 0 ? grid.front : grid.back;
    view.nu = grid.nu;
    view.nv = grid.nv;
    view.shape = surface.shape();
    return view;
}

}  // namespace parallux
