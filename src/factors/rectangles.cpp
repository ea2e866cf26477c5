#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "factors/ways.h"
#include "parallux/spectrum.h"

namespace parallux {

namespace {

// Directions and lengths that differ by no more than this are the same.
constexpr double same = 1e-11;

// A rectangle as a corner, two orthogonal unit axes and its extent along them.
struct Rectangle {
    glm::dvec3 corner, u, v;
    double length_u, length_v;
};

std::optional<Rectangle> as_rectangle(const Polygon& polygon) {
    if (polygon.size() != 4)
        return std::nullopt;
    glm::dvec3 u = polygon[1] - polygon[0], v = polygon[3] - polygon[0];
    glm::dvec3 gap = polygon[2] - polygon[1] - v;
    double length_u = glm::length(u), length_v = glm::length(v);
    if (length_u == 0 || length_v == 0 || std::fabs(glm::dot(u, v)) > same * length_u * length_v ||
        glm::length(gap) > same * std::fmin(length_u, length_v))
        return std::nullopt;
    return Rectangle{polygon[0], u / length_u, v / length_v, length_u, length_v};
}

bool along(const glm::dvec3& a, const glm::dvec3& b) {
    glm::dvec3 across = glm::cross(a, b);
    return glm::dot(across, across) < same * same;
}

// The two ends of an extent along an axis, the lower first.
using Interval = std::array<double, 2>;

Interval interval(const glm::dvec3& axis, const glm::dvec3& from, const glm::dvec3& to) {
    double a = glm::dot(axis, from), b = glm::dot(axis, to);
    return {std::fmin(a, b), std::fmax(a, b)};
}

double sign(std::size_t places) {
    return places % 2 ? -1 : 1;
}

// p √s atan(p / √s), with its limit 0 where both vanish.
double arc(double p, double s) {
    double root = std::sqrt(s);
    return root > 0 ? p * root * std::atan(p / root) : 0;
}

// f ln g, with its limit 0 where g vanishes (f vanishes with it).
double log_term(double f, double g) {
    return g > 0 ? f * std::log(g) : 0;
}

// Planes a distance z apart; x, y of one, ξ, η of the other:
// Σ (-1)^(i+j+k+l) G(x_i - ξ_j, y_k - η_l),
// 2π G(p, q) = q √(p²+z²) atan(q/√(p²+z²)) + p √(q²+z²) atan(p/√(q²+z²)) - z²/2 ln(p²+q²+z²).
double parallel_sum(const Interval& x, const Interval& y, const Interval& xi, const Interval& eta,
                    double z) {
    double sum = 0, z2 = z * z, extent = 0;
    for (double a : {x[0] - xi[1], x[1] - xi[0], y[0] - eta[1], y[1] - eta[0], z})
        extent = std::fmax(extent, a * a);
    for (std::size_t ij = 0; ij < 4; ++ij)
        for (std::size_t kl = 0; kl < 4; ++kl) {
            double p = x[ij / 2] - xi[ij % 2], q = y[kl / 2] - eta[kl % 2];
            double p2 = p * p + z2, q2 = q * q + z2;
            double term = arc(q, p2) + arc(p, q2) - log_term(z2 / 2, (p2 + q * q) / extent);
            sum += sign(ij / 2 + ij % 2 + kl / 2 + kl % 2) * term;
        }
    return sum / (2 * pi);
}

// Planes that meet at a right angle; x, ξ the distances from the common line, y, η along it:
// Σ (-1)^(i+j+k+l) G(x_i² + ξ_j², y_k - η_l),
// 2π G(s, q) = q √s atan(q/√s) - (s - q²)/4 ln(s + q²).
double perpendicular_sum(const Interval& x, const Interval& y, const Interval& xi,
                         const Interval& eta) {
    double sum = 0, extent = x[1] * x[1] + xi[1] * xi[1];
    for (double a : {y[0] - eta[1], y[1] - eta[0]})
        extent = std::fmax(extent, a * a);
    for (std::size_t ij = 0; ij < 4; ++ij)
        for (std::size_t kl = 0; kl < 4; ++kl) {
            double s = x[ij / 2] * x[ij / 2] + xi[ij % 2] * xi[ij % 2];
            double q = y[kl / 2] - eta[kl % 2], q2 = q * q;
            double term = arc(q, s) - log_term((s - q2) / 4, (s + q2) / extent);
            sum += sign(ij / 2 + ij % 2 + kl / 2 + kl % 2) * term;
        }
    return sum / (2 * pi);
}

}  // namespace

std::optional<double> rectangle_exchange(const Polygon& a, const Polygon& b) {
    std::optional<Rectangle> first = as_rectangle(a), second = as_rectangle(b);
    if (!first || !second)
        return std::nullopt;
    glm::dvec3 x = first->u, y = first->v, z = glm::cross(x, y);
    glm::dvec3 facing = glm::cross(second->u, second->v);
    if (!along(second->u, x) && !along(second->u, y) && !along(second->v, x) &&
        !along(second->v, y))
        return std::nullopt;
    // Everything from the first rectangle's corner, where its own coordinates are exact.
    glm::dvec3 low = b[0] - a[0], high = b[2] - a[0];
    if (along(facing, z))
        return parallel_sum({0, first->length_u}, {0, first->length_v}, interval(x, low, high),
                            interval(y, low, high), glm::dot(z, low));
    Interval extent_x{0, first->length_u}, extent_y{0, first->length_v};
    if (along(facing, y)) {
        std::swap(x, y);
        std::swap(extent_x, extent_y);
    } else if (!along(facing, x)) {
        return std::nullopt;
    }
    double plane = glm::dot(x, low);
    Interval distance{std::fabs(extent_x[0] - plane), std::fabs(extent_x[1] - plane)};
    if (distance[0] > distance[1])
        std::swap(distance[0], distance[1]);
    return perpendicular_sum(distance, extent_y, interval(z, low, high), interval(y, low, high));
}

}  // namespace parallux
