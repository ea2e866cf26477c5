#pragma once

#include <functional>
#include <vector>

#include "error_bars/places.h"

namespace parallux::error_bars {

/// Solves with seeds first … first + count - 1, side by side, each on one thread.
std::vector<Solution> solve_seeds(const Place& place, const SolveSettings& settings, int count,
                                  std::uint64_t first, unsigned threads,
                                  const ProgressCallback& progress = {});

/// What 95 % of |t| of so many degrees of freedom stay below; thread-safe.
double t_bound(std::uint32_t freedom);

}  // namespace parallux::error_bars
