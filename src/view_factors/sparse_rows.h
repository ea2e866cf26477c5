#pragma once

#include <cstdint>
#include <vector>

#include "view_factors/pair_counts.h"

namespace parallux {

/// A symmetric matrix by rows, columns ascending, both triangles stored.
struct SparseRows {
    std::vector<std::uint64_t> start{0};
    std::vector<std::uint32_t> column;
    std::vector<double> value;

    std::size_t rows() const { return start.size() - 1; }
};

/// The counts n_ij of all groups; n_ii counts both ends of a line. Empties the counts.
SparseRows take_rows(PairCounts& counts);

/// Without the entries (row, column) that `keep` is false for; it must be symmetric.
template <class Keep>
SparseRows kept(const SparseRows& rows, const Keep& keep) {
    SparseRows result;
    for (std::size_t i = 0; i < rows.rows(); ++i) {
        for (std::uint64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
            if (keep(i, k)) {
                result.column.push_back(rows.column[k]);
                result.value.push_back(rows.value[k]);
            }
        result.start.push_back(result.column.size());
    }
    return result;
}

/// Adds to the diagonal, with new entries where there are none; 0 adds nothing.
void add_to_diagonal(const std::vector<double>& what, SparseRows& rows);

}  // namespace parallux
