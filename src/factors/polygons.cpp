#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "factors/form_factors.h"
#include "factors/ways.h"
#include "parallux/error.h"
#include "parallux/spectrum.h"

namespace parallux {

namespace {

// Distances from a plane below this share of a polygon's size are rounding.
constexpr double flat = 1e-12;

// The sums of 16 terms lose this share of their joint extent squared to rounding.
constexpr double sum_rounding = 1e-15;

// What is lost to rounding in the closed sum, as a share of the value; the value estimated from the
// centres.
double rectangle_loss(const Polygon& a, const Polygon& b) {
    glm::dvec3 from = centre(a), to = centre(b), way = to - from;
    double r2 = glm::dot(way, way), extent = std::sqrt(r2) + radius(a, from) + radius(b, to);
    double value = glm::dot(area_vector(a), way) * -glm::dot(area_vector(b), way) / (pi * r2 * r2);
    return sum_rounding * extent * extent / value;
}

double exchange_in_front(const Polygon& a, const Polygon& b) {
    constexpr double exact_enough = 5e-11;
    std::optional<double> closed = rectangle_exchange(a, b);
    if (closed && rectangle_loss(a, b) < exact_enough)
        return *closed;
    if (std::optional<double> far = cubature_exchange(a, b))
        return *far;
    return closed ? *closed : contour_exchange(a, b);
}

}  // namespace

Polygon::Polygon(std::initializer_list<glm::dvec3> corners) {
    for (const glm::dvec3& corner : corners)
        add(corner);
}

void Polygon::add(const glm::dvec3& corner) {
    append(corner, max_corners);
}

void Polygon::append(const glm::dvec3& corner, std::size_t limit) {
    if (size_ == limit)
        throw Error(Fault::internal, "a polygon for form factors is not convex or has more than " +
                                         std::to_string(max_corners) +
                                         " corners; cut it into parts");
    corners_[size_++] = corner;
}

glm::dvec3 area_vector(const Polygon& polygon) {
    glm::dvec3 sum(0);
    for (std::size_t k = 2; k < polygon.size(); ++k)
        sum += glm::cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    return 0.5 * sum;
}

double area(const Polygon& polygon) {
    return glm::length(area_vector(polygon));
}

glm::dvec3 unit_normal(const Polygon& polygon) {
    // A sliver's area vector is a small difference of large products and leans along it; made
    // orthogonal to the longest edge, the normal keeps all corners in its plane.
    glm::dvec3 vector = area_vector(polygon), longest(0);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        glm::dvec3 edge = polygon.next(k) - polygon[k];
        if (glm::dot(edge, edge) > glm::dot(longest, longest))
            longest = edge;
    }
    if (vector == glm::dvec3(0))
        return vector;
    vector -= glm::dot(vector, longest) / glm::dot(longest, longest) * longest;
    double length = glm::length(vector);
    return length > 0 ? vector / length : glm::dvec3(0);
}

glm::dvec3 centre(const Polygon& polygon) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& corner : polygon)
        sum += corner;
    return sum / static_cast<double>(polygon.size());
}

double radius(const Polygon& polygon, const glm::dvec3& point) {
    double square = 0;
    for (const glm::dvec3& corner : polygon)
        square = std::max(square, glm::dot(corner - point, corner - point));
    return std::sqrt(square);
}

Polygon in_front_of(const Polygon& polygon, const glm::dvec3& origin, const glm::dvec3& normal) {
    std::array<double, Polygon::max_corners + 1> height{};
    double size = 0, highest = 0, lowest = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        height[k] = glm::dot(polygon[k] - origin, normal);
        size = std::max(size, glm::length(polygon.next(k) - polygon[k]));
        highest = std::max(highest, height[k]);
        lowest = std::min(lowest, height[k]);
    }
    if (highest <= flat * size)
        return {};
    if (lowest >= -flat * size)
        return polygon;
    for (double& h : height)
        h = std::fabs(h) <= flat * size ? 0 : h;
    // A convex polygon crosses the plane twice, so that at most one corner comes on top.
    Polygon part;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        double here = height[k], there = height[k + 1 == polygon.size() ? 0 : k + 1];
        if (here >= 0)
            part.append(polygon[k], part.corners_.size());
        if ((here > 0 && there < 0) || (here < 0 && there > 0))
            part.append(polygon[k] + here / (here - there) * (polygon.next(k) - polygon[k]),
                        part.corners_.size());
    }
    return part;
}

double exchange_area(const Polygon& a, const Polygon& b) {
    glm::dvec3 normal_a = unit_normal(a), normal_b = unit_normal(b);
    Polygon part_a = in_front_of(a, b[0], normal_b), part_b = in_front_of(b, a[0], normal_a);
    if (part_a.size() < 3 || part_b.size() < 3)
        return 0;
    return std::max(0.0, exchange_in_front(part_a, part_b));
}

double form_factor(const Polygon& from, const Polygon& to) {
    double own = area(from);
    return own > 0 ? exchange_area(from, to) / own : 0;
}

double seen_from(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to) {
    // F = 1/2π Σ Γ g·n, Γ the angle an edge subtends, g the unit normal of its plane with the
    // point; corners run counter-clockwise as seen, so that g turns away from the inside.
    double sum = 0;
    for (std::size_t k = 0; k < to.size(); ++k) {
        glm::dvec3 first = to[k] - point, second = to.next(k) - point;
        glm::dvec3 across = glm::cross(first, second);
        double sine = glm::length(across);
        if (sine > 0)
            sum -= std::atan2(sine, glm::dot(first, second)) * glm::dot(across, normal) / sine;
    }
    return sum / (2 * pi);
}

double point_form_factor(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to) {
    glm::dvec3 facing = unit_normal(to);
    double height = glm::dot(point - to[0], facing);
    if (height <= 0)
        return 0;
    Polygon part = in_front_of(to, point, normal);
    return part.size() < 3 ? 0 : std::max(0.0, seen_from(point, normal, part));
}

}  // namespace parallux
