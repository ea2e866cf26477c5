#pragma once

#include <functional>
#include <vector>

#include "parallux/solve.h"
#include "support/statistics.h"

namespace parallux::test {

/// Radiosities of each patch over runs with seeds first … first + count - 1.
inline std::vector<Sample> over_seeds(const Scene& scene, const Patches& patches,
                                      SolveSettings settings, int count, std::uint64_t first = 1) {
    std::vector<Sample> samples(patches.count() * patches.bands);
    for (int k = 0; k < count; ++k) {
        settings.seed = first + static_cast<std::uint64_t>(k);
        Solution solution = solve(scene, patches, settings);
        for (std::size_t patch = 0; patch < samples.size(); ++patch)
            samples[patch].add(solution.radiosity[patch]);
    }
    return samples;
}

/// Largest |z| of all patches against one expected value each.
inline double worst_z(const std::vector<Sample>& samples,
                      const std::function<double(std::size_t)>& expected) {
    double worst = 0;
    for (std::size_t k = 0; k < samples.size(); ++k)
        worst = std::max(worst, std::fabs(samples[k].z(expected(k))));
    return worst;
}

/// Largest |z| of the differences of two independent sets of runs (Welch).
inline double worst_difference(const std::vector<Sample>& a, const std::vector<Sample>& b) {
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        double spread = std::hypot(a[k].standard_error(), b[k].standard_error());
        double difference = std::fabs(a[k].mean() - b[k].mean());
        if (difference > 1e-6 * std::fabs(a[k].mean()))
            worst = std::max(worst, difference / std::max(spread, 1e-300));
    }
    return worst;
}

/// z of the area-weighted means of a set of runs, taken run by run.
inline Sample mean_over_seeds(const Scene& scene, const Patches& patches, SolveSettings settings,
                              int count, std::uint64_t first = 1) {
    Sample sample;
    for (int k = 0; k < count; ++k) {
        settings.seed = first + static_cast<std::uint64_t>(k);
        Solution solution = solve(scene, patches, settings);
        double sum = 0, area = 0;
        for (std::size_t patch = 0; patch < patches.count(); ++patch) {
            sum += patches.area[patch] * solution.radiosity[patch * patches.bands];
            area += patches.area[patch];
        }
        sample.add(sum / area);
    }
    return sample;
}

}  // namespace parallux::test
