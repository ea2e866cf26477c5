#include "error_bars/seeds.h"

#include <array>

#include "parallel.h"
#include "support/statistics.h"

namespace parallux::error_bars {

std::vector<Solution> solve_seeds(const Place& place, const SolveSettings& settings, int count,
                                  std::uint64_t first, unsigned threads,
                                  const ProgressCallback& progress) {
    std::vector<Solution> runs(static_cast<std::size_t>(count));
    parallel_for(threads, runs.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k) {
            SolveSettings own = settings;
            own.threads = 1;
            own.seed = first + k;
            runs[k] = solve(place.scene, place.patches, own, progress);
        }
    });
    return runs;
}

double t_bound(std::uint32_t freedom) {
    // Rounds of eight groups, so that few are met.
    static const std::array<double, 128> bounds = [] {
        std::array<double, 128> all{};
        for (std::uint32_t k = 1; k < all.size(); ++k)
            all[k] = test::sidak_bound(1, static_cast<int>(k) + 1, 0.05);
        return all;
    }();
    return bounds[std::min<std::size_t>(freedom, bounds.size() - 1)];
}

}  // namespace parallux::error_bars
