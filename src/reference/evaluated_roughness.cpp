#include "reference/evaluated_roughness.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "parallux/spectrum.h"

namespace parallux {

using glm::dot;
using glm::dvec3;

namespace {

// Density of facets about the normal, at this cosine.
double facing(double square, double cosine) {
    const double bottom = cosine * cosine * (square - 1) + 1;
    return square / (pi * bottom * bottom);
}

}  // namespace

EvaluatedRoughness::EvaluatedRoughness(double alpha) : square_(alpha * alpha) {
    for (int k = 0; k <= steps; ++k)
        kept_[k] = albedo(std::max(0.5, double(k)) / steps);
    for (int k = 0; k < 1000; ++k)
        mean_ += 2 * (k + 0.5) / 1e6 * kept((k + 0.5) / 1000);
}

double EvaluatedRoughness::facets(const dvec3& n, const dvec3& a, const dvec3& b) const {
    const dvec3 half = glm::normalize(a + b);
    const double na = dot(n, a), nb = dot(n, b);
    const double seen = nb * std::sqrt(square_ + (1 - square_) * na * na) +
                        na * std::sqrt(square_ + (1 - square_) * nb * nb);
    return pi * facing(square_, dot(n, half)) * 0.5 / seen;
}

double EvaluatedRoughness::kept(double cosine) const {
    const double at = std::min(cosine * steps, steps - 1e-9);
    const int k = static_cast<int>(at);
    return kept_[k] + (at - k) * (kept_[k + 1] - kept_[k]);
}

// ∫ f cos θ, in the half vector's own angles, where it is smooth.
double EvaluatedRoughness::albedo(double cosine) const {
    const dvec3 a(std::sqrt(1 - cosine * cosine), 0, cosine), n(0, 0, 1);
    constexpr int across = 400, about = 100;
    double sum = 0;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < about; ++j) {
            // tan² θ = α² u / (1 - u) has the density of facets.
            const double u = (i + 0.5) / across, angle = 2 * pi * (j + 0.5) / about;
            const double z = std::sqrt((1 - u) / (1 + (square_ - 1) * u));
            const double r = std::sqrt(std::max(0.0, 1 - z * z));
            const dvec3 half(r * std::cos(angle), r * std::sin(angle), z);
            const double ah = dot(a, half);
            const dvec3 b = 2 * ah * half - a;
            if (ah <= 0 || b.z <= 0)
                continue;
            sum += facets(n, a, b) / pi * b.z * 4 * ah / (facing(square_, z) * z);
        }
    return sum / (across * about);
}

}  // namespace parallux
