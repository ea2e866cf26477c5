#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "factors/visible.h"

// The planes of a shaft's sides: E. Haines, J. Wallace, Shaft culling for efficient ray-traced
// radiosity, Eurographics Workshop on Rendering 1991; here of the polygons themselves, not of their
// boxes.

namespace parallux {

namespace {

// Distances below this share of the shaft's length are rounding.
constexpr double flat = 1e-12;

}  // namespace

Shaft::Shaft(const Polygon& from, const Polygon& to)
    : from_(from), to_(to), low_(from[0]), high_(from[0]) {
    for (const Polygon* polygon : {&from, &to})
        for (const glm::dvec3& corner : *polygon) {
            low_ = glm::min(low_, corner);
            high_ = glm::max(high_, corner);
        }
    near_ = flat * glm::length(high_ - low_);
    planes_[count_++] = {from[0], -unit_normal(from)};
    planes_[count_++] = {to[0], -unit_normal(to)};
    add_sides(from, to);
    add_sides(to, from);
}

// Through an edge of one and a corner of the other, where that leaves both on one side.
void Shaft::add_sides(const Polygon& a, const Polygon& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
        for (const glm::dvec3& corner : b) {
            Plane plane{a[k], glm::cross(a.next(k) - a[k], corner - a[k])};
            const double length = glm::length(plane.normal);
            if (!(length > flat * glm::length(a.next(k) - a[k]) * glm::length(corner - a[k])))
                continue;
            plane.normal /= length;
            double low = 0, high = 0;
            for (const Polygon* polygon : {&a, &b})
                for (const glm::dvec3& other : *polygon) {
                    const double height = glm::dot(other - plane.origin, plane.normal);
                    low = std::min(low, height);
                    high = std::max(high, height);
                }
            if (low < -near_ && high > near_)
                continue;
            if (high > near_)
                plane.normal = -plane.normal;
            if (count_ < planes_.size())
                planes_[count_++] = plane;
            break;
        }
}

bool Shaft::outside(const Polygon& polygon, const Plane& plane) const {
    return std::all_of(polygon.begin(), polygon.end(), [&](const glm::dvec3& corner) {
        return glm::dot(corner - plane.origin, plane.normal) >= -near_;
    });
}

bool Shaft::holds(const Polygon& blocker) const {
    glm::dvec3 low = blocker[0], high = blocker[0];
    for (const glm::dvec3& corner : blocker) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    for (int axis = 0; axis < 3; ++axis)
        if (low[axis] >= high_[axis] + near_ || high[axis] <= low_[axis] - near_)
            return false;
    for (std::size_t k = 0; k < count_; ++k)
        if (outside(blocker, planes_[k]))
            return false;
    // What has both polygons on one side hides nothing.
    const Plane own{blocker[0], unit_normal(blocker)};
    const Plane other{blocker[0], -own.normal};
    return !(outside(from_, own) && outside(to_, own)) &&
           !(outside(from_, other) && outside(to_, other));
}

}  // namespace parallux
