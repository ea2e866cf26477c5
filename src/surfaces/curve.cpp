#include "surfaces/curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "parallux/error.h"

namespace parallux {

namespace {

struct Along {
    glm::dvec3 at, per_s;
};

// Bernstein's polynomials of degree 3, and their derivatives.
struct Bernstein {
    std::array<double, 4> at, slope;

    explicit Bernstein(double s) {
        const double r = 1 - s;
        at = {r * r * r, 3 * s * r * r, 3 * s * s * r, s * s * s};
        slope = {-3 * r * r, 3 * r * (r - 2 * s), 3 * s * (2 * r - s), 3 * s * s};
    }
};

Along profile_at(const Curve& c, double s) {
    if (c.profile == Curve::Profile::line)
        return {c.point[0] + s * (c.point[1] - c.point[0]), c.point[1] - c.point[0]};
    if (c.profile == Curve::Profile::arc) {
        const double turn = c.end - c.start, angle = c.start + s * turn;
        const double x = c.radius * std::cos(angle), y = c.radius * std::sin(angle);
        return {c.point[0] + x * c.point[1] + y * c.point[2],
                turn * (x * c.point[2] - y * c.point[1])};
    }
    const Bernstein b(s);
    Along along{glm::dvec3(0), glm::dvec3(0)};
    for (std::size_t k = 0; k < 4; ++k) {
        along.at += b.at[k] * c.point[k];
        along.per_s += b.slope[k] * c.point[k];
    }
    return along;
}

CurvePoint whole_at(const Curve& c, double s, double t) {
    if (c.kind == Curve::Kind::bicubic) {
        const Bernstein a(s), b(t);
        CurvePoint p{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::dvec3& q = c.point[4 * j + i];
                p.at += a.at[i] * b.at[j] * q;
                p.per_u += a.slope[i] * b.at[j] * q;
                p.per_v += a.at[i] * b.slope[j] * q;
            }
        return p;
    }
    const Along along = profile_at(c, s);
    if (c.kind == Curve::Kind::swept)
        return {along.at + t * c.sweep, along.per_s, c.sweep};
    const double whole = 2 * pi * c.turn, angle = whole * t;
    const glm::dvec3 out = std::cos(angle) * c.frame[0] + std::sin(angle) * c.frame[1];
    const glm::dvec3 round = std::cos(angle) * c.frame[1] - std::sin(angle) * c.frame[0];
    return {c.origin + along.at.x * out + along.at.y * c.frame[2],
            along.per_s.x * out + along.per_s.y * c.frame[2], whole * along.at.x * round};
}

// How far a chord's middle lies beside it, and its length.
struct Bend {
    double off, length;
};
Bend bend_of(const Curve& c, bool along_u, double from, double to, double across) {
    auto at = [&](double w) {
        return along_u ? curve_at(c, w, across).at : curve_at(c, across, w).at;
    };
    const glm::dvec3 a = at(from), way = at(to) - a;
    const double length = glm::length(way);
    // Quarters too: an S has its middle on the chord.
    double off = 0;
    for (double w : {0.25, 0.5, 0.75}) {
        const glm::dvec3 out = at(from + w * (to - from)) - a;
        off = std::max(off,
                       length > 0 ? glm::length(glm::cross(out, way)) / length : glm::length(out));
    }
    return {off, length};
}

}  // namespace

CurvePoint curve_at(const Curve& curve, double u, double v) {
    const glm::dvec2 size = curve.high - curve.low;
    CurvePoint p = whole_at(curve, curve.low.x + u * size.x, curve.low.y + v * size.y);
    p.per_u *= size.x;
    p.per_v *= size.y;
    return p;
}

glm::dvec3 curve_normal(const Curve& curve, double u, double v) {
    // At a pole one derivative vanishes: look a little nearer to the middle.
    for (double step : {0.0, 1e-6, 1e-3, 0.1}) {
        const CurvePoint p = curve_at(curve, u + step * (0.5 - u), v + step * (0.5 - v));
        const glm::dvec3 normal = glm::cross(p.per_u, p.per_v);
        const double size = glm::length(p.per_u) * glm::length(p.per_v);
        const double length = glm::length(normal);
        const double most = std::max(glm::dot(p.per_u, p.per_u), glm::dot(p.per_v, p.per_v));
        if (length > 1e-9 * size && size > 1e-12 * most)
            return normal / length;
    }
    return {0, 0, 1};
}

Bounds curve_bounds(const Curve& curve, double u0, double u1, double v0, double v1, int points) {
    if (is_whole_sphere(curve)) {
        const glm::dvec3 centre = sphere_centre(curve);
        return {centre - curve.radius, centre + curve.radius};
    }
    std::vector<glm::dvec3> at;
    for (int j = 0; j <= points; ++j)
        for (int i = 0; i <= points; ++i)
            at.push_back(
                curve_at(curve, u0 + (u1 - u0) * i / points, v0 + (v1 - v0) * j / points).at);
    Bounds bounds{at[0], at[0]};
    glm::dvec3 bulge_u(0), bulge_v(0);
    const auto row = static_cast<std::size_t>(points) + 1;
    for (std::size_t k = 0; k < at.size(); ++k) {
        bounds.low = glm::min(bounds.low, at[k]);
        bounds.high = glm::max(bounds.high, at[k]);
        // Between points a surface leaves their polygon by an eighth of the second difference.
        if (k % row > 0 && k % row + 1 < row)
            bulge_u = glm::max(bulge_u, glm::abs(at[k - 1] - 2.0 * at[k] + at[k + 1]));
        if (k >= row && k + row < at.size())
            bulge_v = glm::max(bulge_v, glm::abs(at[k - row] - 2.0 * at[k] + at[k + row]));
    }
    const glm::dvec3 room = 0.25 * (bulge_u + bulge_v);
    return {bounds.low - room, bounds.high + room};
}

std::vector<double> curve_cuts(const Curve& curve, bool along_u, std::uint32_t cells, double chord,
                               double bend) {
    constexpr int places = 8;
    // Near a pole chords are so short that nothing but rounding is left of them.
    const Bounds box = curve_bounds(curve, 0, 1, 0, 1, 4);
    const double nothing = 1e-9 * glm::length(box.high - box.low);
    std::vector<double> cuts{0};
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
        const double from = double(cell) / cells, size = 1.0 / cells;
        auto fine = [&](std::uint32_t parts) {
            for (std::uint32_t k = 0; k < parts; ++k)
                for (int place = 0; place <= places; ++place) {
                    const Bend b = bend_of(curve, along_u, from + size * k / parts,
                                           from + size * (k + 1) / parts, double(place) / places);
                    if (b.off > chord + nothing || b.off > bend * b.length + nothing)
                        return false;
                }
            return true;
        };
        std::uint32_t parts = 1;
        while (!fine(parts)) {
            parts += (parts + 3) / 4;
            if (cuts.size() + parts > 1u << 16)
                throw Error(Fault::memory,
                            "a curved surface is too large for this --line-spacing; choose a "
                            "larger one");
        }
        for (std::uint32_t k = 1; k < parts; ++k)
            cuts.push_back(from + size * k / parts);
        cuts.push_back(cell + 1 == cells ? 1 : double(cell + 1) / cells);
    }
    return cuts;
}

}  // namespace parallux
