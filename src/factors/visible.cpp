#include "factors/visible.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "parallux/spectrum.h"

namespace parallux {

namespace {

// Distances from a plane below this share of the lengths that they come from are rounding.
constexpr double flat = 1e-12;

using Heights = std::array<double, Cone::max_corners>;

// One side of a blocker's cone.
struct Side {
    glm::dvec3 normal;  // inward
    double near;        // heights below this are rounding
};

// Of a cone's corners above the plane through its point; what rounding may have made is 0.
// Returns the highest and the lowest.
std::pair<double, double> heights(const Cone& cone, const Side& side, Heights& height) {
    double highest = 0, lowest = 0;
    for (std::size_t k = 0; k < cone.size; ++k) {
        const double above = glm::dot(cone.corners[k], side.normal);
        height[k] = std::fabs(above) <= side.near ? 0 : above;
        highest = std::max(highest, height[k]);
        lowest = std::min(lowest, height[k]);
    }
    return {highest, lowest};
}

// The part of a cone where sign · height ≥ 0.
Cone part_of(const Cone& cone, const Heights& height, double sign) {
    Cone part;
    for (std::size_t k = 0; k < cone.size; ++k) {
        const std::size_t next = k + 1 == cone.size ? 0 : k + 1;
        const double here = sign * height[k], there = sign * height[next];
        if (here >= 0)
            part.corners[part.size++] = cone.corners[k];
        if ((here > 0 && there < 0) || (here < 0 && there > 0))
            part.corners[part.size++] =
                cone.corners[k] + here / (here - there) * (cone.corners[next] - cone.corners[k]);
    }
    return part;
}

// A cut adds a corner at most, and a blocker has up to eight sides: a cone that might run out of
// room goes in halves.
void keep(const Cone& cone, std::vector<Cone>& cones) {
    constexpr std::size_t few = Cone::max_corners - (Polygon::max_corners + 1);
    if (cone.size <= few) {
        cones.push_back(cone);
        return;
    }
    const std::size_t half = cone.size / 2;
    Cone first, second;
    for (std::size_t k = 0; k <= half; ++k)
        first.corners[first.size++] = cone.corners[k];
    for (std::size_t k = half; k < cone.size; ++k)
        second.corners[second.size++] = cone.corners[k];
    second.corners[second.size++] = cone.corners[0];
    cones.push_back(first);
    cones.push_back(second);
}

// Cuts the cone of a blocker, given by the inward normals of its sides, out of another.
void cut_out(const Cone& cone, std::span<const Side> sides, std::vector<Cone>& seen) {
    Heights height;
    for (const Side& side : sides)
        if (heights(cone, side, height).first <= 0)
            return keep(cone, seen);
    Cone hidden = cone;
    for (const Side& side : sides) {
        const auto [highest, lowest] = heights(hidden, side, height);
        if (lowest < 0)
            keep(part_of(hidden, height, -1), seen);
        if (highest <= 0)
            return;
        if (lowest < 0)
            hidden = part_of(hidden, height, 1);
    }
}

double seen_through(const Cone& cone, const glm::dvec3& normal) {
    // As seen_from(): F = 1/2π Σ Γ g·n.
    double sum = 0;
    for (std::size_t k = 0; k < cone.size; ++k) {
        const glm::dvec3& first = cone.corners[k];
        const glm::dvec3& second = cone.corners[k + 1 == cone.size ? 0 : k + 1];
        const glm::dvec3 across = glm::cross(first, second);
        const double sine = glm::length(across);
        if (sine > 0)
            sum -= std::atan2(sine, glm::dot(first, second)) * glm::dot(across, normal) / sine;
    }
    return sum / (2 * pi);
}

// Whether all of a polygon lies outside one side of a cone, whose corners turn by `turn`.
bool beside(const Polygon& polygon, const glm::dvec3& point, const Cone& cone, double turn) {
    for (std::size_t k = 0; k < cone.size; ++k) {
        const glm::dvec3 side =
            turn * glm::cross(cone.corners[k], cone.corners[k + 1 == cone.size ? 0 : k + 1]);
        if (std::all_of(polygon.begin(), polygon.end(), [&](const glm::dvec3& corner) {
                return glm::dot(corner - point, side) <= 0;
            }))
            return true;
    }
    return false;
}

}  // namespace

double visible_form_factor(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to,
                           std::span<const Polygon> blockers, VisibleScratch& scratch) {
    const glm::dvec3 facing = unit_normal(to);
    if (glm::dot(point - to[0], facing) <= 0)
        return 0;
    const Polygon whole = in_front_of(to, point, normal);
    if (whole.size() < 3)
        return 0;
    Cone cone;
    double far = 0;
    for (const glm::dvec3& corner : whole) {
        cone.corners[cone.size++] = corner - point;
        far = std::max(far, glm::dot(corner - point, corner - point));
    }
    far = std::sqrt(far);
    scratch.seen.assign(1, cone);
    for (const Polygon& blocker : blockers) {
        // What hides lies on the point's side of the plane of `to`, and on the way.
        if (beside(blocker, point, cone, -1))
            continue;
        const Polygon between = in_front_of(blocker, to[0], facing);
        if (between.size() < 3)
            continue;
        const double turn = glm::dot(area_vector(between), between[0] - point);
        if (std::fabs(turn) <= flat * area(between) * glm::length(between[0] - point))
            continue;
        std::array<Side, Polygon::max_corners + 1> sides;
        for (std::size_t k = 0; k < between.size(); ++k) {
            const glm::dvec3 inward =
                std::copysign(1.0, turn) * glm::cross(between[k] - point, between.next(k) - point);
            sides[k] = {inward, flat * far * glm::length(inward)};
        }
        scratch.left.clear();
        for (const Cone& part : scratch.seen)
            cut_out(part, {sides.data(), between.size()}, scratch.left);
        scratch.seen.swap(scratch.left);
        if (scratch.seen.empty())
            return 0;
    }
    double sum = 0;
    for (const Cone& part : scratch.seen)
        sum += seen_through(part, normal);
    return std::max(0.0, sum);
}

}  // namespace parallux
