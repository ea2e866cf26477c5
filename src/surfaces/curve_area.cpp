#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "factors/gauss_legendre.h"
#include "surfaces/curve.h"

namespace parallux {

namespace {

const GaussRule rule(8);

template <class F>
double gauss(double from, double to, F&& f) {
    double sum = 0;
    for (const GaussNode& node : rule)
        sum += node.weight * f(0.5 * (from + to) + 0.5 * (to - from) * node.place);
    return 0.5 * (to - from) * sum;
}

// |∂p/∂u × ∂p/∂v|.
double stretch(const Curve& c, double u, double v) {
    const CurvePoint p = curve_at(c, u, v);
    return glm::length(glm::cross(p.per_u, p.per_v));
}

// Area a unit of u, of v0 … v1. Only bicubic patches stretch unevenly along v.
double strip(const Curve& c, double u, double v0, double v1) {
    if (c.kind == Curve::Kind::bicubic)
        return gauss(v0, v1, [&](double v) { return stretch(c, u, v); });
    return (v1 - v0) * stretch(c, u, 0.5);
}

// Halves along u and v, where that is needed, until both halves' rules agree with the whole's.
double refine(const Curve& c, double u0, double u1, double v0, double v1, double whole,
              double error, int depth) {
    const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
    const bool split_v = c.kind == Curve::Kind::bicubic;
    auto part = [&](double a, double b, double from, double to) {
        return gauss(a, b, [&](double at) { return strip(c, at, from, to); });
    };
    if (!split_v) {
        const double low = part(u0, u, v0, v1), high = part(u, u1, v0, v1);
        if (!(std::fabs(low + high - whole) > error) || depth == 0)
            return low + high;
        return refine(c, u0, u, v0, v1, low, error / 2, depth - 1) +
               refine(c, u, u1, v0, v1, high, error / 2, depth - 1);
    }
    const double parts[4] = {part(u0, u, v0, v), part(u, u1, v0, v), part(u0, u, v, v1),
                             part(u, u1, v, v1)};
    const double sum = parts[0] + parts[1] + parts[2] + parts[3];
    if (!(std::fabs(sum - whole) > error) || depth == 0)
        return sum;
    return refine(c, u0, u, v0, v, parts[0], error / 4, depth - 1) +
           refine(c, u, u1, v0, v, parts[1], error / 4, depth - 1) +
           refine(c, u0, u, v, v1, parts[2], error / 4, depth - 1) +
           refine(c, u, u1, v, v1, parts[3], error / 4, depth - 1);
}

// Where a growing function of [0, 1], 0 and 1 at its ends, has a value: Illinois' regula falsi.
template <class F>
double solve(double value, F&& f) {
    double low = 0, high = 1, below = -value, above = 1 - value;
    if (!(below < 0))
        return 0;
    if (!(above > 0))
        return 1;
    int side = 0;
    for (int step = 0; step < 60 && high - low > 1e-12; ++step) {
        const double middle = (low * above - high * below) / (above - below),
                     at = f(middle) - value;
        if (std::fabs(at) < 1e-12)
            return middle;
        if (at < 0) {
            low = middle, below = at;
            if (side == -1)
                above /= 2;
            side = -1;
        } else {
            high = middle, above = at;
            if (side == 1)
                below /= 2;
            side = 1;
        }
    }
    return 0.5 * (low + high);
}

}  // namespace

double curve_area(const Curve& c, double u0, double u1, double v0, double v1) {
    const double s0 = c.low.x + u0 * (c.high.x - c.low.x), s1 = c.low.x + u1 * (c.high.x - c.low.x);
    const double turn = std::fabs(2 * pi * c.turn * (c.high.y - c.low.y) * (v1 - v0));
    if (c.kind == Curve::Kind::revolved && c.profile == Curve::Profile::line) {
        // Pappus: the middle goes round by the distance it has from the axis.
        const double length = glm::length(c.point[1] - c.point[0]) * std::fabs(s1 - s0);
        const double middle = c.point[0].x + 0.5 * (s0 + s1) * (c.point[1].x - c.point[0].x);
        return turn * length * middle;
    }
    if (c.kind == Curve::Kind::revolved && c.profile == Curve::Profile::arc) {
        // ∫ (x + r cos a) r da.
        const double a0 = c.start + s0 * (c.end - c.start), a1 = c.start + s1 * (c.end - c.start);
        // sin a1 - sin a0 as a product, which keeps its digits in small cells.
        const double sines = 2 * std::cos(0.5 * (a0 + a1)) * std::sin(0.5 * (a1 - a0));
        return turn * c.radius * std::fabs(c.point[0].x * (a1 - a0) + c.radius * sines);
    }
    const double whole = gauss(u0, u1, [&](double u) { return strip(c, u, v0, v1); });
    // Far from the origin derivatives are known to the rounding of coordinates only.
    double far = 0;
    for (const glm::dvec2& uv : {glm::dvec2(u0, v0), glm::dvec2(u1, v1)})
        far = std::max(far, glm::length(curve_at(c, uv.x, uv.y).at));
    return refine(c, u0, u1, v0, v1, whole, 1e-11 * whole + 1e-15 * far * std::sqrt(whole), 12);
}

glm::dvec2 curve_place(const Curve& c, double u0, double u1, double v0, double v1, double a,
                       double b) {
    auto up_to = [&](double share) {
        return gauss(u0, u0 + share * (u1 - u0), [&](double u) { return strip(c, u, v0, v1); });
    };
    const double whole = up_to(1);
    const double u = u0 + (u1 - u0) * solve(a, [&](double share) { return up_to(share) / whole; });
    if (c.kind != Curve::Kind::bicubic)
        return {u, v0 + b * (v1 - v0)};
    auto across = [&](double share) {
        return gauss(v0, v0 + share * (v1 - v0), [&](double v) { return stretch(c, u, v); });
    };
    const double all = across(1);
    if (!(all > 0))
        return {u, v0 + b * (v1 - v0)};
    return {u, v0 + (v1 - v0) * solve(b, [&](double share) { return across(share) / all; })};
}

}  // namespace parallux
