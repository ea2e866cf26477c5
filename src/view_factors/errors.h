#pragma once

#include "parallux/factors.h"
#include "view_factors/pair_counts.h"
#include "view_factors/sparse_rows.h"

namespace parallux {

/// Standard errors of the means of all groups from their spread; none from one group. Those to the
/// outside are of the shares n_ik / n_i of each group; between nodes of the counts n_ij, which
/// also spread with n_i, so that theirs are rather too large. `rows` are counts.
void set_errors(const PairCounts& counts, const SparseRows& rows, Factors& factors);

}  // namespace parallux
