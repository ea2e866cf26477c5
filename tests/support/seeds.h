#pragma once

#include <functional>
#include <vector>

#include "parallel.h"
#include "parallux/solve.h"
#include "support/statistics.h"

namespace parallux::test {

/// The radiosities of runs with seeds first … first + count - 1, side by side on all cores.
inline std::vector<std::vector<float>> runs(const Scene& scene, const Patches& patches,
                                            SolveSettings settings, int count,
                                            std::uint64_t first) {
    std::vector<std::vector<float>> results(static_cast<std::size_t>(count));
    settings.threads = 1;
    parallel_for(0, results.size(), 1, [&](std::size_t begin, std::size_t, unsigned) {
        SolveSettings own = settings;
        own.seed = first + begin;
        results[begin] = solve(scene, patches, own).radiosity;
    });
    return results;
}

/// Radiosities of each patch over such runs.
inline std::vector<Sample> over_seeds(const Scene& scene, const Patches& patches,
                                      const SolveSettings& settings, int count,
                                      std::uint64_t first = 1) {
    std::vector<Sample> samples(patches.count() * patches.bands);
    for (const std::vector<float>& run : runs(scene, patches, settings, count, first))
        for (std::size_t patch = 0; patch < samples.size(); ++patch)
            samples[patch].add(run[patch]);
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

/// Area-weighted means of the first band, run by run.
inline Sample mean_over_seeds(const Scene& scene, const Patches& patches,
                              const SolveSettings& settings, int count, std::uint64_t first = 1) {
    Sample sample;
    for (const std::vector<float>& run : runs(scene, patches, settings, count, first)) {
        double sum = 0, area = 0;
        for (std::size_t patch = 0; patch < patches.count(); ++patch) {
            sum += patches.area[patch] * run[patch * patches.bands];
            area += patches.area[patch];
        }
        sample.add(sum / area);
    }
    return sample;
}

}  // namespace parallux::test
