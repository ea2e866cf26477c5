#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "output/exposed.h"
#include "parallux/solve.h"

namespace parallux {

/// Fits a linear function to the irradiance of some patches around a point of a smooth surface.
class LocalFit {
public:
    LocalFit(const std::vector<ExposedPatch>& patches, const Solution& solution)
        : patches_(patches), solution_(solution) {}

    /// The fit's value at `place`, one a band. `around` are the patches that touch the place,
    /// `near` all that may take part. Not below zero; beyond the range of the patches' values only
    /// where the place lies outside of them, and then only as far as the values lie on a line.
    void evaluate(const glm::dvec3& place, std::span<const std::uint32_t> around,
                  std::span<const std::uint32_t> near, float* values);

private:
    struct Sample {
        double x, y, weight;
        std::uint32_t patch;
    };

    double irradiance(std::uint32_t patch, std::uint32_t band) const {
        const ExposedPatch& p = patches_[patch];
        float h = solution_.irradiance[std::size_t(patch) * solution_.bands + band];
        return std::max(h - p.cover[band], 0.0f) / p.share;
    }
    void gather(const glm::dvec3& place, std::span<const std::uint32_t> around,
                std::span<const std::uint32_t> near);

    const std::vector<ExposedPatch>& patches_;
    const Solution& solution_;
    std::vector<Sample> samples_;
    double size_ = 0;
};

}  // namespace parallux
