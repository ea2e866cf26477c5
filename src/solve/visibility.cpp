#include "solve/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "factors/ways.h"

namespace parallux {

namespace {

struct RulePoint {
    double a, b, weight;  // in the cell's own axes
};

// Gauss-Legendre, 2 × 2; and D. Dunavant's rule of degree 4 (High degree efficient symmetrical
// Gaussian quadrature rules for the triangle, IJNME 21, 1985).
constexpr double low = 0.21132486540518713, high = 1 - low;
constexpr std::array<RulePoint, 4> square_rule{
    {{low, low, 0.25}, {high, low, 0.25}, {low, high, 0.25}, {high, high, 0.25}}};
constexpr double a1 = 0.816847572980459, b1 = 0.091576213509771, w1 = 0.109951743655322;
constexpr double a2 = 0.108103018168070, b2 = 0.445948490915965, w2 = 0.223381589678011;
constexpr std::array<RulePoint, 6> triangle_rule{
    {{a1, b1, w1}, {b1, a1, w1}, {b1, b1, w1}, {a2, b2, w2}, {b2, a2, w2}, {b2, b2, w2}}};

glm::dvec3 at(const Polygon& cell, double a, double b) {
    return cell[0] + a * (cell[1] - cell[0]) + b * (cell[cell.size() - 1] - cell[0]);
}

// A uniform point of a convex polygon from two numbers of [0, 1): of a fan of triangles, one chosen
// by area.
glm::dvec3 point_in(const Polygon& polygon, double a, double b) {
    std::array<double, Polygon::max_corners + 1> up_to{};
    for (std::size_t k = 2; k < polygon.size(); ++k)
        up_to[k] = up_to[k - 1] +
                   glm::length(glm::cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]));
    a *= up_to[polygon.size() - 1];
    std::size_t k = 2;
    while (k + 1 < polygon.size() && a >= up_to[k])
        ++k;
    a = (a - up_to[k - 1]) / (up_to[k] - up_to[k - 1]);
    const double root = std::sqrt(a);
    return polygon[0] +
           root * ((1 - b) * (polygon[k - 1] - polygon[0]) + b * (polygon[k] - polygon[0]));
}

double mean_by_rule(const Polygon& cell, const Polygon& source) {
    const glm::dvec3 normal = unit_normal(cell);
    double sum = 0;
    const std::span<const RulePoint> rule =
        cell.size() == 4 ? std::span<const RulePoint>(square_rule) : triangle_rule;
    for (const RulePoint& point : rule)
        sum += point.weight * point_form_factor(at(cell, point.a, point.b), normal, source);
    return sum;
}

}  // namespace

Polygon whole_polygon(const Scene& scene, std::uint32_t surface, bool back) {
    return polygon_of(scene, {surface, 0, back, {0, 0, 0, 0.5, 0.5, 0, 0, 1, 1}});
}

double exchange_nearly(const Polygon& cell, const Polygon& source) {
    constexpr double far = 4;  // radii
    const glm::dvec3 middle = centre(cell), other = centre(source);
    const double above = std::fabs(glm::dot(middle - other, unit_normal(source)));
    const double beside = glm::length(middle - other) - radius(source, other);
    if (std::max(above, beside) < far * radius(cell, middle))
        return exchange_area(cell, source);
    return area(cell) * mean_by_rule(cell, source);
}

std::vector<std::uint32_t> PointViews::between(const Polygon& from, const Polygon& to,
                                               std::uint32_t own, std::uint32_t source) const {
    std::vector<std::uint32_t> found;
    const Shaft shaft(from, to);
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s)
        if (s != own && s != source && shaft.holds(surfaces_[s]))
            found.push_back(s);
    return found;
}

void PointViews::hide(std::span<const std::uint32_t> blockers) {
    blockers_.clear();
    for (std::uint32_t blocker : blockers)
        blockers_.push_back(surfaces_[blocker]);
}

double PointViews::seen_from(const Emitter& cell, const glm::dvec3& normal, double a, double b,
                             const Polygon& to) {
    const glm::dvec3 point = point_on(scene_, cell, a, b);
    if (rays_.covered(cell.surface, normal, point))
        return 0;
    return visible_form_factor(point, normal, to, blockers_, scratch_);
}

double PointViews::mean(const Emitter& cell, const Polygon& to,
                        std::span<const std::uint32_t> blockers, std::uint32_t k, Random& random) {
    hide(blockers);
    const glm::dvec3 normal = emitter_normal(scene_, cell);
    const double x = random.uniform(), y = random.uniform();
    double sum = 0;
    for (std::uint32_t row = 0; row < k; ++row)
        for (std::uint32_t column = 0; column < k; ++column)
            for (auto [a, b] : {std::pair(x, y), std::pair(1 - x, 1 - y)})
                sum += seen_from(cell, normal, (column + a) / k, (row + b) / k, to);
    return sum / (2.0 * k * k);
}

std::uint32_t PointViews::grid_for(const Emitter& cell, const Polygon& to,
                                   std::span<const std::uint32_t> blockers) {
    hide(blockers);
    const glm::dvec3 normal = emitter_normal(scene_, cell);
    double least = INFINITY, most = 0, whole = 0;
    for (auto [a, b] :
         {std::pair(0.5, 0.5), {0.02, 0.02}, {0.98, 0.02}, {0.02, 0.98}, {0.98, 0.98}}) {
        const double seen = seen_from(cell, normal, a, b, to);
        least = std::min(least, seen);
        most = std::max(most, seen);
        whole = std::max(whole, point_form_factor(point_on(scene_, cell, a, b), normal, to));
    }
    const double change = whole > 0 ? (most - least) / whole : 0;
    return change < 0.1 ? 1 : change < 0.4 ? 2 : 4;
}

double visible_share(const Scene& scene, const RayScene& rays, const Source& source,
                     const Emitter& cell, std::uint32_t count, Random& random) {
    // Points of the four-dimensional R sequence (M. Roberts, The unreasonable effectiveness of
    // quasirandom sequences, 2018): even on both polygons, and on their pairs.
    constexpr double step[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378086,
                                0.5385972572236100};
    const glm::dvec3 n = emitter_normal(scene, source.piece), m = emitter_normal(scene, cell);
    // What lies behind the other's plane takes no part.
    const Polygon polygon = polygon_of(scene, cell);
    const Polygon from = in_front_of(source.polygon, polygon[0], m);
    const Polygon to = in_front_of(polygon, source.polygon[0], n);
    if (from.size() < 3 || to.size() < 3)
        return 0;
    double start[4];
    for (double& s : start)
        s = random.uniform();
    double seen = 0, all = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        double p[4];
        for (int axis = 0; axis < 4; ++axis) {
            const double x = start[axis] + step[axis] * k;
            p[axis] = x - std::floor(x);
        }
        const glm::dvec3 a = point_in(from, p[0], p[1]);
        const glm::dvec3 b = point_in(to, p[2], p[3]);
        const glm::dvec3 way = b - a;
        const double square = glm::dot(way, way);
        const double kernel = glm::dot(way, n) * -glm::dot(way, m) / (square * square);
        if (!(kernel > 0))
            continue;
        all += kernel;
        if (!rays.blocked(a, b, source.piece.surface, cell.surface))
            seen += kernel;
    }
    return all > 0 ? seen / all : 0;
}

std::uint32_t rays_for(const Scene& scene, const RayScene& rays, const Source& source,
                       const Emitter& cell) {
    constexpr std::uint32_t tries = 32, few = 8, many = 64;
    Random random(cell.patch, stream::first_shot + 2);
    const double share = visible_share(scene, rays, source, cell, tries, random);
    return share > 0 && share < 1 ? many : few;
}

}  // namespace parallux
