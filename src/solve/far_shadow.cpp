#include "solve/far_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/periodic.h"

namespace parallux {

namespace {

// Whether the ray from a point meets a box.
bool meets(const Bounds& box, const glm::dvec3& from, const glm::dvec3& toward) {
    double enter = 0, leave = 1e300;
    for (int k = 0; k < 3; ++k) {
        const double slack = 1e-9 * (1 + std::fabs(box.high[k]) + std::fabs(box.low[k]));
        const double low = box.low[k] - slack - from[k], high = box.high[k] + slack - from[k];
        if (std::fabs(toward[k]) < 1e-12) {
            if (low > 0 || high < 0)
                return false;
            continue;
        }
        const double a = low / toward[k], b = high / toward[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

}  // namespace

FarShadow::FarShadow(const RayScene& rays, const Scene& scene)
    : rays_(rays),
      bounds_(scene_bounds(scene)),
      up_(scene.sky.up),
      period_(scene.period),
      along_{glm::dvec3(0), glm::dvec3(0)},
      extent_{glm::dvec2(0), glm::dvec2(0)} {
    far_ = 2 * glm::distance(bounds_.low, bounds_.high);
    top_ = -1e300;
    for (const glm::dvec3& position : scene.positions)
        top_ = std::max(top_, glm::dot(position, up_));
    // Dual to the periods, in their plane.
    for (int k = 0; k < 2; ++k) {
        const double length = glm::length(period_[k]);
        if (length == 0)
            continue;
        const glm::dvec3& other = period_[1 - k];
        glm::dvec3 across = period_[k];
        if (glm::length(other) > 0)
            across -= glm::dot(across, other) / glm::dot(other, other) * other;
        along_[k] = across / glm::dot(across, period_[k]);
        extent_[k] = {1e300, -1e300};
        for (const glm::dvec3& position : scene.positions) {
            const double place = glm::dot(position, along_[k]);
            extent_[k] = {std::min(extent_[k].x, place), std::max(extent_[k].y, place)};
        }
        far_ += most_copies * length;
    }
}

bool FarShadow::blocked(const glm::dvec3& point, const glm::dvec3& toward,
                        std::uint32_t surface) const {
    if (rays_.blocked(point, point + far_ * toward, surface))
        return true;
    // Copies that the ray passes before it is above all of them.
    const double rise = glm::dot(toward, up_), height = top_ - glm::dot(point, up_);
    const double length = rise * far_ > height ? std::max(height, 0.0) / rise : far_;
    std::int32_t first[2], last[2];
    for (int k = 0; k < 2; ++k) {
        const double begin = glm::dot(point, along_[k]);
        const double end = begin + length * glm::dot(toward, along_[k]);
        auto whole = [](double x) {
            return static_cast<std::int32_t>(std::clamp(x, -most_copies, most_copies));
        };
        first[k] = whole(std::floor(std::min(begin, end) - extent_[k].y));
        last[k] = whole(std::ceil(std::max(begin, end) - extent_[k].x));
        if (along_[k] == glm::dvec3(0))
            first[k] = last[k] = 0;
    }
    for (std::int32_t i = first[0]; i <= last[0]; ++i)
        for (std::int32_t j = first[1]; j <= last[1]; ++j) {
            // In the place of the copy, the ray is moved.
            const glm::dvec3 from = point - double(i) * period_[0] - double(j) * period_[1];
            if ((i != 0 || j != 0) && meets(bounds_, from, toward) &&
                rays_.blocked(from, from + far_ * toward))
                return true;
        }
    return false;
}

}  // namespace parallux
