#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "surfaces/curve.h"

namespace parallux {

namespace {

// Puts (s, t) on the part that is left of the whole; false: it is trimmed away.
bool within(const Curve& c, double s, double t, CurveRoot& root) {
    root.u = (s - c.low.x) / (c.high.x - c.low.x);
    root.v = (t - c.low.y) / (c.high.y - c.low.y);
    return root.u >= 0 && root.u <= 1 && root.v >= 0 && root.v <= 1;
}

// a t² + 2 b t + c = 0, without cancellation.
int solve(double a, double b, double c, double* t) {
    const double rest = b * b - a * c;
    if (!(rest > 0))
        return 0;
    const double q = -(b + std::copysign(std::sqrt(rest), b));
    int count = 0;
    if (a != 0)
        t[count++] = q / a;
    if (q != 0)
        t[count++] = c / q;
    return count;
}

}  // namespace

bool is_quadric(const Curve& c) {
    return c.kind == Curve::Kind::revolved &&
           (c.profile == Curve::Profile::line ||
            (c.profile == Curve::Profile::arc && c.point[0].x == 0));
}

bool is_whole_sphere(const Curve& c) {
    return is_quadric(c) && c.profile == Curve::Profile::arc && c.turn == 1 && c.start == -pi / 2 &&
           c.end == pi / 2 && c.low.x == 0 && c.high.x == 1 && std::min(c.low.y, c.high.y) == 0 &&
           std::max(c.low.y, c.high.y) == 1;
}

glm::dvec3 sphere_centre(const Curve& c) {
    return c.origin + c.point[0].y * c.frame[2];
}

int quadric_roots(const Curve& c, const glm::dvec3& origin, const glm::dvec3& direction,
                  CurveRoot* roots) {
    // In the curve's own frame.
    const glm::dvec3 from = origin - c.origin;
    glm::dvec3 o, d;
    for (int axis = 0; axis < 3; ++axis) {
        o[axis] = glm::dot(from, c.frame[axis]);
        d[axis] = glm::dot(direction, c.frame[axis]);
    }
    const double r0 = c.point[0].x, z0 = c.point[0].y;
    const bool line = c.profile == Curve::Profile::line;
    const double dr = line ? c.point[1].x - r0 : 0, dz = line ? c.point[1].y - z0 : 0;
    double t[2];
    int count = 0;
    if (line && dz == 0) {
        if (d.z != 0)
            t[count++] = (z0 - o.z) / d.z;
    } else {
        // From the line's point nearest to the axis' foot, so that far rays lose no digits.
        const glm::dvec3 foot(0, 0, line ? z0 + 0.5 * dz : z0);
        const double shift = glm::dot(foot - o, d) / glm::dot(d, d);
        const glm::dvec3 p = o + shift * d - glm::dvec3(0, 0, z0);
        if (line) {
            const double k = dr / dz, r = r0 + k * p.z;
            count = solve(d.x * d.x + d.y * d.y - k * k * d.z * d.z,
                          p.x * d.x + p.y * d.y - k * d.z * r, p.x * p.x + p.y * p.y - r * r, t);
        } else {
            count = solve(glm::dot(d, d), glm::dot(p, d), glm::dot(p, p) - c.radius * c.radius, t);
        }
        for (int k = 0; k < count; ++k)
            t[k] += shift;
    }
    int found = 0;
    for (int k = 0; k < count; ++k) {
        const glm::dvec3 p = o + t[k] * d;
        const double distance = std::hypot(p.x, p.y);
        double angle = std::atan2(p.y, p.x);
        if (angle < 0)
            angle += 2 * pi;
        double s = 0;
        if (!line)
            s = (std::atan2(p.z - z0, distance) - c.start) / (c.end - c.start);
        else if (dz == 0)
            s = (distance - r0) / dr;
        else
            s = (p.z - z0) / dz;
        // The other half of a cone is none of it.
        if (line && dz != 0 && r0 + s * dr < 0)
            continue;
        roots[found].t = t[k];
        if (within(c, s, std::min(1.0, angle / (2 * pi * c.turn)), roots[found]) &&
            angle <= 2 * pi * c.turn)
            ++found;
    }
    return found;
}

bool is_disk(const Curve& c) {
    return c.kind == Curve::Kind::revolved && c.profile == Curve::Profile::line &&
           c.point[0].y == c.point[1].y;
}

std::array<glm::dvec3, 4> disk_square(const Curve& c) {
    const glm::dvec3 middle = c.origin + c.point[0].y * c.frame[2];
    const double radius = std::max(c.point[0].x, c.point[1].x);
    const glm::dvec3 x = radius * c.frame[0], y = radius * c.frame[1];
    return {middle - x - y, middle + x - y, middle + x + y, middle - x + y};
}

bool on_disk(const Curve& c, const glm::dvec3& point, double& u, double& v) {
    CurveRoot roots[2];
    if (quadric_roots(c, point, c.frame[2], roots) == 0)
        return false;
    u = roots[0].u;
    v = roots[0].v;
    return true;
}

int newton_roots(const Curve& c, const glm::dvec3& origin, const glm::dvec3& direction, double u0,
                 double u1, double v0, double v1, CurveRoot* roots) {
    constexpr int most = 4, steps = 12;
    const double du = u1 - u0, dv = v1 - v0;
    int found = 0;
    // From one place the root is found, unless the line grazes the surface: then there may be two.
    const glm::dvec3 middle = curve_normal(c, 0.5 * (u0 + u1), 0.5 * (v0 + v1));
    const bool grazes = std::fabs(glm::dot(middle, direction)) < 0.5 * glm::length(direction);
    constexpr double places[5][2] = {{0.5, 0.5}, {0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}, {0.9, 0.9}};
    for (int place = 0; place < (grazes ? 5 : 1) && found < most; ++place) {
        double u = u0 + places[place][0] * du, v = v0 + places[place][1] * dv, t = 0;
        bool done = false;
        for (int step = 0; step < steps && !done; ++step) {
            // p + a ∂u + b ∂v = origin + t direction, by Cramer's rule.
            const CurvePoint p = curve_at(c, u, v);
            const glm::dvec3 way = origin - p.at, across = glm::cross(p.per_v, -direction);
            const double volume = glm::dot(p.per_u, across);
            if (volume == 0)
                break;
            const double a = glm::dot(way, across) / volume;
            const double b = glm::dot(p.per_u, glm::cross(way, -direction)) / volume;
            t = glm::dot(p.per_u, glm::cross(p.per_v, way)) / volume;
            u += std::clamp(a, -du, du);
            v += std::clamp(b, -dv, dv);
            if (!(u > u0 - du && u < u1 + du && v > v0 - dv && v < v1 + dv))
                break;
            done = std::fabs(a) < 1e-10 * du && std::fabs(b) < 1e-10 * dv;
        }
        // Cells are half open, so that neighbours do not both have what lies between them.
        if (!done || !(u >= u0 && v >= v0 && (u < u1 || (u1 == 1 && u <= 1)) &&
                       (v < v1 || (v1 == 1 && v <= 1))))
            continue;
        const bool known = std::any_of(roots, roots + found, [&](const CurveRoot& other) {
            return std::fabs(other.u - u) < 1e-6 * du && std::fabs(other.v - v) < 1e-6 * dv;
        });
        if (!known)
            roots[found++] = {t, u, v};
    }
    return found;
}

}  // namespace parallux
