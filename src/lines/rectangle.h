#pragma once

#include <algorithm>
#include <cmath>

#include "lines/edge_walk.h"
#include "parallux/lines.h"

namespace parallux {

/// Lines of a bundle: columns left … right - 1, rows top … bottom - 1.
struct Rectangle {
    std::int32_t left, right, top, bottom;

    bool empty() const { return left >= right || top >= bottom; }
};

/// The lines about a sphere.
inline Rectangle ball_rectangle(const Projection::Ball& ball) {
    auto first = [](double at) { return static_cast<std::int32_t>(std::ceil(at)); };
    return {first(ball.x - ball.radius), first(ball.x + ball.radius), first(ball.y - ball.radius),
            first(ball.y + ball.radius)};
}

/// The lines that a surface's snapped corners enclose.
inline Rectangle rectangle_of(const Projection& projection, const Surface& surface) {
    if (surface.is_curved())
        return ball_rectangle(projection.balls[surface.curve]);
    unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    const Projection::Corner& first = projection.corners[surface.corner[0]];
    std::int32_t low_x = first.x, high_x = first.x, low_y = first.y, high_y = first.y;
    for (unsigned k = 1; k < corners; ++k) {
        const Projection::Corner& corner = projection.corners[surface.corner[k]];
        low_x = std::min(low_x, corner.x);
        high_x = std::max(high_x, corner.x);
        low_y = std::min(low_y, corner.y);
        high_y = std::max(high_y, corner.y);
    }
    return {first_line(low_x), first_line(high_x), first_line(low_y), first_line(high_y)};
}

}  // namespace parallux
