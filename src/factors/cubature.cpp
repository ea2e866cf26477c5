#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "factors/gauss_legendre.h"
#include "factors/ways.h"
#include "parallux/spectrum.h"

namespace parallux {

namespace {

// The points a side that a rule needs on a polygon of this radius whose integrand has its nearest
// singularity at this distance from the centre: the error falls as ρ^-2n, ρ the semi-axes' sum of
// the largest ellipse about the polygon without a singularity.
std::size_t points_needed(double radius, double distance) {
    constexpr double accuracy = 1e-11;
    double ratio = distance / radius;
    if (!(ratio > 1))
        return std::numeric_limits<std::size_t>::max();
    double rho = ratio + std::sqrt(ratio * ratio - 1);
    return static_cast<std::size_t>(std::ceil(-std::log(accuracy) / (2 * std::log(rho))));
}

// The distance of `point` from the polygon's edges.
double edge_distance(const glm::dvec3& point, const Polygon& polygon) {
    double square = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        glm::dvec3 edge = polygon.next(k) - polygon[k], way = point - polygon[k];
        double length2 = glm::dot(edge, edge);
        double t = length2 > 0 ? std::clamp(glm::dot(way, edge) / length2, 0.0, 1.0) : 0;
        glm::dvec3 rest = way - t * edge;
        square = std::min(square, glm::dot(rest, rest));
    }
    return std::sqrt(square);
}

struct Point {
    glm::dvec3 place;
    double area;
};

// A rule over a polygon: tensor rules on quadrangles, (u, v) bilinear between their corners; a
// triangle is one with two corners in one place.
struct Rule {
    static constexpr std::size_t most = 3 * GaussRule::most * GaussRule::most;
    std::array<Point, most> points;
    std::size_t size = 0;

    Rule(const Polygon& polygon, const glm::dvec3& normal, std::size_t n) {
        for (std::size_t k = 1; k + 1 < polygon.size(); k += 2)
            add_quadrangle({polygon[0], polygon[k], polygon[k + 1],
                            polygon[std::min(k + 2, polygon.size() - 1)]},
                           normal, n);
    }

    const Point* begin() const { return points.data(); }
    const Point* end() const { return points.data() + size; }

private:
    void add_quadrangle(const std::array<glm::dvec3, 4>& p, const glm::dvec3& normal,
                        std::size_t n) {
        glm::dvec3 middle = (p[0] + p[1] + p[2] + p[3]) / 4.0;
        glm::dvec3 along_u = (p[1] + p[2] - p[0] - p[3]) / 4.0;
        glm::dvec3 along_v = (p[2] + p[3] - p[0] - p[1]) / 4.0;
        glm::dvec3 twist = (p[0] - p[1] + p[2] - p[3]) / 4.0;
        for (const auto& [u, weight_u] : GaussRule(n))
            for (const auto& [v, weight_v] : GaussRule(n)) {
                glm::dvec3 across = glm::cross(along_u + v * twist, along_v + u * twist);
                points[size++] = {middle + u * along_u + v * along_v + u * v * twist,
                                  weight_u * weight_v * glm::dot(across, normal)};
            }
    }
};

// Σ Σ cosθ cosθ' / (π r²), both cosines from unscaled normals.
double kernel_sum(const Rule& a, const glm::dvec3& normal_a, const Rule& b,
                  const glm::dvec3& normal_b) {
    double sum = 0;
    for (const Point& from : a) {
        double inner = 0;
        for (const Point& to : b) {
            glm::dvec3 way = to.place - from.place;
            double r2 = glm::dot(way, way);
            inner += to.area * glm::dot(way, normal_a) * -glm::dot(way, normal_b) / (r2 * r2);
        }
        sum += from.area * inner;
    }
    return sum / pi;
}

}  // namespace

std::optional<double> cubature_exchange(const Polygon& a, const Polygon& b) {
    // One edge seen from a point costs about as much as this many values of the kernel.
    constexpr std::size_t edge_cost = 12;
    glm::dvec3 centre_a = centre(a), centre_b = centre(b);
    double radius_a = radius(a, centre_a), radius_b = radius(b, centre_b);
    if (radius_a > radius_b)
        return cubature_exchange(b, a);
    double apart = glm::length(centre_b - centre_a);
    glm::dvec3 normal_a = unit_normal(a), normal_b = unit_normal(b);
    // Points on both where both are small, or points on the smaller that see all of the larger.
    std::size_t n_a = points_needed(radius_a, apart - radius_b);
    std::size_t n_b = points_needed(radius_b, apart - radius_a);
    if (n_a <= GaussRule::most && n_b <= GaussRule::most && n_b * n_b <= edge_cost * b.size())
        return kernel_sum(Rule(a, normal_a, n_a), normal_a, Rule(b, normal_b, n_b), normal_b);
    n_a = points_needed(radius_a, edge_distance(centre_a, b));
    if (n_a > GaussRule::most)
        return std::nullopt;
    double sum = 0;
    for (const Point& point : Rule(a, normal_a, n_a))
        sum += point.area * seen_from(point.place, normal_a, b);
    return sum;
}

}  // namespace parallux
