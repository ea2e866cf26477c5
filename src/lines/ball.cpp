#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/ball.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <glm/geometric.hpp>

#include "lines/ball.h"
#include "lines/depth_order.h"
#include "lines/facets.h"
#include "lines/hits-inl.h"
#include "surfaces/curve.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

// The same arithmetic as of many lines.
Hit one_hit(const SurfaceView& view, std::int32_t column, std::int32_t row) {
    const hn::CappedTag<float, 1> d;
    const auto hits = hits_of(d, view, hn::Set(d, static_cast<float>(column - view.column)),
                              static_cast<float>(row - view.row));
    const auto cell = static_cast<std::uint32_t>(hn::GetLane(hits.cell));
    return {hn::GetLane(hits.depth), view.surface, view.toward == none ? none : view.toward + cell,
            view.away == none ? none : view.away + cell};
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

HWY_EXPORT(one_hit);

Hit ball_hit(const SurfaceView& view, std::int32_t column, std::int32_t row) {
    return HWY_DYNAMIC_DISPATCH(one_hit)(view, column, row);
}

void project_balls(const Bundle& bundle, const Scene& scene, const glm::dvec3& centre,
                   Projection& projection) {
    projection.balls.clear();
    for (const Curve& curve : scene.curves) {
        const glm::dvec3 middle = sphere_centre(curve) - centre;
        Projection::Ball ball;
        ball.x = glm::dot(middle, bundle.x) / bundle.spacing + bundle.offset_x;
        ball.y = glm::dot(middle, bundle.y) / bundle.spacing + bundle.offset_y;
        ball.radius = curve.radius / bundle.spacing;
        ball.depth = glm::dot(middle, bundle.direction) / projection.radius;
        ball.per_spacing = bundle.spacing / projection.radius;
        const glm::dmat3 to_own = glm::transpose(curve.frame);
        ball.axes = glm::mat3(to_own * glm::dmat3(bundle.x, bundle.y, bundle.direction));
        ball.turned = curve.low.y > curve.high.y;
        projection.balls.push_back(ball);
    }
}

SurfaceView ball_view(const Projection& projection, const Scene& scene, const Patches& patches,
                      std::uint32_t s) {
    const Surface& surface = scene.surfaces[s];
    const Projection::Ball& ball = projection.balls[surface.curve];
    const bool far = is_far_half(surface);
    SurfaceView view;
    view.ball = &ball;
    view.far = far;
    view.column = static_cast<std::int32_t>(std::floor(ball.x));
    view.row = static_cast<std::int32_t>(std::floor(ball.y));
    // Of the slopes that a sphere has, all to 64, but for a line in thousands at its outline.
    view.moved = near_tie(projection.bundle.spacing, projection.radius);
    view.slack = view.moved + 1e-6f;
    view.surface = s;
    // A sphere that is turned has its front outside: it is met first.
    const SurfaceGrid& grid = patches.grids[s];
    const bool front_first = ball.turned != far;
    view.toward = front_first ? grid.front : grid.back;
    view.away = front_first ? grid.back : grid.front;
    view.nu = grid.nu;
    view.nv = grid.nv;
    return view;
}

}  // namespace parallux
#endif
