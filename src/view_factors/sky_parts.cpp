#include "view_factors/sky_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {

namespace {

constexpr std::uint32_t rows = 7;
constexpr std::uint32_t parts_of_row[rows] = {30, 30, 24, 24, 18, 12, 6};

std::uint32_t count_of(std::uint32_t split) {
    std::uint32_t count = 1;
    for (std::uint32_t parts : parts_of_row)
        count += parts * split * split;
    return split == 0 ? 1 : count;
}

std::uint32_t split_of(SkyParts parts) {
    return parts == SkyParts::whole ? 0 : parts == SkyParts::tregenza ? 1 : 2;
}

}  // namespace

SkyDome::SkyDome(SkyParts parts, const glm::dvec3& up, const glm::dvec3& north)
    : split_(split_of(parts)), count_(count_of(split_)), up_(up) {
    north_ = north - glm::dot(north, up) * up;
    if (glm::dot(north_, north_) < 1e-12)
        north_ = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    north_ = glm::normalize(north_ - glm::dot(north_, up) * up);
    east_ = glm::cross(north_, up_);
}

std::uint32_t SkyDome::part(const glm::dvec3& direction) const {
    const double height = glm::dot(direction, up_);
    if (height <= 0)
        return count_;
    if (split_ == 0)
        return 0;
    const double step = 0.5 * pi / (rows * split_ + 0.5);
    const auto row = static_cast<std::uint32_t>(std::asin(std::min(height, 1.0)) / step);
    if (row >= rows * split_)
        return count_ - 1;
    std::uint32_t before = 0;
    for (std::uint32_t r = 0; r < row; ++r)
        before += parts_of_row[r / split_] * split_;
    const std::uint32_t parts = parts_of_row[row / split_] * split_;
    double turn = std::atan2(glm::dot(direction, east_), glm::dot(direction, north_)) / (2 * pi);
    turn += turn < 0 ? 1 : 0;
    return before + static_cast<std::uint32_t>(turn * parts + 0.5) % parts;
}

}  // namespace parallux
