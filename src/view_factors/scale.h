#pragma once

#include <vector>

#include "view_factors/sparse_rows.h"

namespace parallux {

/// A closed account of areas, m².
struct Account {
    SparseRows exchange;          ///< symmetric, to the bit
    std::vector<double> outside;  ///< of each row, all that goes outside
    std::vector<double> scale;    ///< d_i: outside_i = d_i · what was counted
    double rest = 0;              ///< put on the diagonal where no scaling closes the row, m²
    bool closed = false;          ///< by scaling alone, but for empty rows
};

/// exchange_ij = d_i n_ij d_j and outside_i = d_i s_i with row sums area_i, to about 1e-14 of them.
/// `counts` and `outside` are in m² already, as near as counted lines are; a row may be empty.
/// What cannot be reached (few lines from a large node to a small one) is cut down alike on both
/// sides, and what is then missing stands on the diagonal. `scale` is where to begin, empty: 1.
Account close_account(SparseRows counts, const std::vector<double>& outside,
                      const std::vector<double>& area, const std::vector<double>& scale,
                      unsigned threads);

}  // namespace parallux
