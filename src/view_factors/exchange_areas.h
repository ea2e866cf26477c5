#pragma once

#include "parallux/factors.h"
#include "view_factors/pair_counts.h"
#include "view_factors/sparse_rows.h"

namespace parallux {

/// Exchange areas and factors to the outside from counts: closed, and closed again without what is
/// below the threshold. `rows` are counts of nodes; `factors` has nodes, bundles and line spacing.
void set_exchange(const PairCounts& counts, SparseRows rows, const FactorSettings& settings,
                  Factors& factors);

}  // namespace parallux
