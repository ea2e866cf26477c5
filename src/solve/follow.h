#pragma once

#include <vector>

#include "solve/follow_groups.h"
#include "solve/ways.h"

namespace parallux {

/// x = P (u + ρ x) between regions, as GroupSystem has it between groups; `group`: of each region;
/// `received`: what it received before. Conjugate gradients (M. R. Hestenes and E. Stiefel, 1952),
/// started and led by the system between groups, to some thousandths of all that each group
/// receives (Settled). O(kept lines) a step, steps by how long light is held within groups. The
/// same on any number of threads.
std::vector<double> follow(const RegionWays& ways, const std::vector<double>& reflectance,
                           const std::vector<double>& unshot, const std::vector<double>& received,
                           std::uint32_t bands, const std::vector<std::uint32_t>& group,
                           const GroupSystem& groups, unsigned threads);

}  // namespace parallux
