#pragma once

#include <optional>

#include "parallux/factors.h"
#include "view_factors/pair_counts.h"
#include "view_factors/sky_shares.h"
#include "view_factors/sparse_rows.h"

namespace parallux {

/// Exchange areas and factors to the outside from counts: closed, and closed again without what is
/// below the threshold. `rows` are counts of nodes; `factors` has nodes, errors, bundles and line
/// spacing. With `known` sky factors those stay, but for 1e-4 of their change as counts of the sky
/// would change, where the rest of the rows can be made to fit; otherwise they give way as far as
/// they must, and their errors tell.
void set_exchange(const PairCounts& counts, SparseRows rows, const std::optional<SkyShares>& known,
                  const FactorSettings& settings, Factors& factors);

}  // namespace parallux
