#include "materials/microfacets.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "parallux/spectrum.h"

namespace parallux {

namespace {

// Λ of Smith's masking.
double masking(double alpha, const glm::dvec3& w) {
    const double square = w.z * w.z;
    return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - square) / square) - 1);
}

// A facet's normal as seen from w, of two numbers of [0, 1).
glm::dvec3 seen_facet(double alpha, const glm::dvec3& w, double a, double b) {
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * w.x, alpha * w.y, w.z));
    const double across = stretched.x * stretched.x + stretched.y * stretched.y;
    const glm::dvec3 x = across > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / std::sqrt(across)
                                    : glm::dvec3(1, 0, 0);
    const glm::dvec3 y = glm::cross(stretched, x);
    const double radius = std::sqrt(a), angle = 2 * pi * b, part = 0.5 * (1 + stretched.z);
    const double u = radius * std::cos(angle);
    const double v = (1 - part) * std::sqrt(1 - u * u) + part * radius * std::sin(angle);
    const glm::dvec3 n = u * x + v * y + std::sqrt(std::max(0.0, 1 - u * u - v * v)) * stretched;
    return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(1e-12, n.z)));
}

// What of a seen facet's light nothing stops: G2 / G1.
double passes(double alpha, const glm::dvec3& from, const glm::dvec3& to) {
    if (to.z <= 0)
        return 0;
    const double seen = masking(alpha, from);
    return (1 + seen) / (1 + seen + masking(alpha, to));
}

constexpr int cosines = 64, points_a_side = 128;

}  // namespace

Microfacets::Microfacets(double alpha) : alpha_(alpha), single_(cosines + 1) {
    for (int k = 0; k <= cosines; ++k) {
        const double z = std::max(1e-4, std::pow(k / double(cosines), 2));
        const glm::dvec3 from(std::sqrt(1 - z * z), 0, z);
        double sum = 0;
        for (int i = 0; i < points_a_side; ++i)
            for (int j = 0; j < points_a_side; ++j) {
                // Finer where facets are steep, which of a smooth mirror are few, and stop most.
                const double t = (i + 0.5) / points_a_side;
                const glm::dvec3 facet =
                    seen_facet(alpha, from, 1 - t * t * t, (j + 0.5) / points_a_side);
                sum +=
                    3 * t * t * (1 - passes(alpha, from, 2 * glm::dot(from, facet) * facet - from));
            }
        single_[k] = 1 - sum / (points_a_side * points_a_side);
        most_lost_ = std::max(most_lost_, 1 - single_[k]);
    }
}

double Microfacets::single(double cosine) const {
    const double at = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * cosines;
    const int k = std::min(static_cast<int>(at), cosines - 1);
    return single_[k] + (at - k) * (single_[k + 1] - single_[k]);
}

glm::dvec3 Microfacets::sample(const glm::dvec3& from, Random& random, double& along_facet) const {
    const double a = random.uniform(), b = random.uniform();
    const glm::dvec3 facet = seen_facet(alpha_, from, a, b);
    const glm::dvec3 to = 2 * glm::dot(from, facet) * facet - from;
    along_facet = std::clamp(glm::dot(from, facet), 0.0, 1.0);
    if (random.uniform() < passes(alpha_, from, to))
        return to;
    // The rest, 1 - single(from) in the mean, leaves by (1 - single(to)) cos θ.
    along_facet = std::sqrt(0.5);
    for (int tried = 0;; ++tried) {
        const double square = random.uniform(), z = std::sqrt(1 - square);
        if (tried < 1000 && random.uniform() * most_lost_ >= 1 - single(z))
            continue;
        const double radius = std::sqrt(square), angle = 2 * pi * random.uniform();
        return {radius * std::cos(angle), radius * std::sin(angle), std::max(z, 1e-9)};
    }
}

}  // namespace parallux
