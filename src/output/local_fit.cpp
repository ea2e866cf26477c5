#include "output/local_fit.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "output/neighbours.h"

namespace parallux {

namespace {

// The symmetric 2 × 2 inverse of the points' spread, without directions in which they do not
// spread: there a slope would only magnify noise.
struct Inverse {
    double xx, xy, yy;
};

Inverse spread_inverse(double xx, double xy, double yy, double size) {
    double middle = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
    double root = std::sqrt(half * half + xy * xy);
    // Unit eigenvector of the larger eigenvalue.
    double angle = 0.5 * std::atan2(xy, half);
    double c = std::cos(angle), s = std::sin(angle);
    auto inverse = [size](double spread) {
        // Full from a tenth of a patch side of standard deviation, nothing below half that.
        double deviation = std::sqrt(std::max(spread, 0.0)) / size;
        double t = std::clamp((deviation - 0.05) / 0.05, 0.0, 1.0);
        return t > 0 ? t * t * (3 - 2 * t) / spread : 0.0;
    };
    double large = inverse(middle + root), small = inverse(middle - root);
    return {large * c * c + small * s * s, (large - small) * c * s, large * s * s + small * c * c};
}

}  // namespace

void LocalFit::gather(const glm::dvec3& place, std::span<const std::uint32_t> around,
                      std::span<const std::uint32_t> near) {
    // Lay the tangent plane by the patches that touch the place.
    glm::dvec3 normal(0);
    size_ = 0;
    for (std::uint32_t p : around) {
        normal += patches_[p].area * patches_[p].normal;
        size_ = std::max(size_, patches_[p].size);
    }
    normal = glm::normalize(normal);
    glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dvec3 tangent = glm::normalize(glm::cross(normal, helper));
    glm::dvec3 bitangent = glm::cross(normal, tangent);
    // Weigh each patch by its area and its distance, over the larger of the two sizes.
    samples_.clear();
    for (std::uint32_t p : near) {
        glm::dvec3 way = patches_[p].mean - place;
        double radius = reach_in_sides * std::max(size_, patches_[p].size);
        double near_by = 1 - glm::dot(way, way) / (radius * radius);
        if (near_by > 0)
            samples_.push_back({glm::dot(way, tangent), glm::dot(way, bitangent),
                                patches_[p].area * near_by * near_by, p});
    }
    if (samples_.empty())
        for (std::uint32_t p : around)
            samples_.push_back({0, 0, patches_[p].area, p});
}

void LocalFit::evaluate(const glm::dvec3& place, std::span<const std::uint32_t> around,
                        std::span<const std::uint32_t> near, float* values) {
    gather(place, around, near);
    // Take the weighted mean of the points, and their spread about it.
    double weight = 0, x = 0, y = 0;
    for (const Sample& s : samples_)
        weight += s.weight, x += s.weight * s.x, y += s.weight * s.y;
    x /= weight, y /= weight;
    double xx = 0, xy = 0, yy = 0;
    for (const Sample& s : samples_) {
        xx += s.weight * (s.x - x) * (s.x - x);
        xy += s.weight * (s.x - x) * (s.y - y);
        yy += s.weight * (s.y - y) * (s.y - y);
    }
    Inverse inverse = spread_inverse(xx / weight, xy / weight, yy / weight, size_);
    // Follow each band's slope from the mean to the place.
    for (std::uint32_t band = 0; band < solution_.bands; ++band) {
        double low = HUGE_VAL, high = -HUGE_VAL, mean = 0;
        for (const Sample& s : samples_) {
            double h = irradiance(s.patch, band);
            low = std::min(low, h), high = std::max(high, h), mean += s.weight * h;
        }
        mean /= weight;
        double hx = 0, hy = 0, hh = 0;
        for (const Sample& s : samples_) {
            double h = irradiance(s.patch, band) - mean;
            hx += s.weight * (s.x - x) * h, hy += s.weight * (s.y - y) * h;
            hh += s.weight * h * h;
        }
        hx /= weight, hy /= weight, hh /= weight;
        double slope_x = inverse.xx * hx + inverse.xy * hy;
        double slope_y = inverse.xy * hx + inverse.yy * hy;
        double step = -slope_x * x - slope_y * y;
        // Go beyond the patches' values only as far as they lie on the line.
        double residual = hh > 0 ? 1 - (slope_x * hx + slope_y * hy) / hh : 1;
        double trust = std::clamp(1 - 6 * residual, 0.0, 1.0);
        double beyond = trust * std::min(std::abs(step), high - low);
        double value = std::clamp(mean + step, low - beyond, high + beyond);
        values[band] = static_cast<float>(std::max(value, 0.0));
    }
}

}  // namespace parallux
