#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallux/factors.h"
#include "parallux/solve.h"

namespace parallux::factor_bench {

/// What a method finds of an open scene: factors by rows (columns ascending), the sky's share of
/// each row, and the net short wave under a sky of irradiance 1 on open ground.
struct Answer {
    std::vector<std::uint64_t> start{0};
    std::vector<std::uint32_t> column;
    std::vector<double> factor;
    std::vector<double> sky;
    std::vector<double> net;
    double seconds = 0;  ///< of the processor, all of it
};

/// Our bundles, counted, closed and reciprocal; then the reflections. `sky_from` and
/// `lines_per_patch`: as in FactorSettings.
Answer by_bundles(const Scene& scene, const Patches& patches, std::uint64_t bundles,
                  std::uint64_t seed, unsigned threads, SkyFrom sky_from,
                  double lines_per_patch = 0);

/// Puts sky factors of triangles from 400 points each, 25 in each sixteenth, in the place of those
/// of `answer`, and reflects anew.
void with_fine_sky(const Scene& scene, const Patches& patches, Answer& answer);

/// The competent alternative: from each facet `rays` rays by the cosine law, Sobol points in place
/// and direction, each facet's moved on by a random step, the nearest hit by Embree; then the
/// reflections.
Answer by_rays(const Scene& scene, const Patches& patches, std::uint32_t rays, std::uint64_t seed);

/// The solver itself, which needs no factors: net short wave alone.
Answer by_solve(const Scene& scene, const Patches& patches, std::uint64_t bundles,
                std::uint64_t seed);

}  // namespace parallux::factor_bench
