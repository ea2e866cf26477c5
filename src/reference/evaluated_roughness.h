#pragma once

#include <array>

#include <glm/vec3.hpp>

namespace parallux {

/// GGX with α, of a mirror that reflects all, by evaluation: the judge of Microfacets, which
/// samples it, and shares nothing with it. Values are times π: f cos θ over the density of
/// directions by the cosine. All vectors unit, above the surface.
class EvaluatedRoughness {
public:
    explicit EvaluatedRoughness(double alpha);

    /// What single facets reflect from a to b, n the normal.
    double facets(const glm::dvec3& n, const glm::dvec3& a, const glm::dvec3& b) const;
    /// What Kulla and Conty give back, between directions of these cosines.
    double between(double na, double nb) const {
        return (1 - kept(na)) * (1 - kept(nb)) / (1 - mean_);
    }

private:
    static constexpr int steps = 50;
    double kept(double cosine) const;
    double albedo(double cosine) const;

    double square_, mean_ = 0;
    std::array<double, steps + 1> kept_;  // albedo of single facets, at even cosines
};

}  // namespace parallux
