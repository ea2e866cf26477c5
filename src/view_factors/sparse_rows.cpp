#include "view_factors/sparse_rows.h"

namespace parallux {

namespace {

// Calls visit(i, j, count) for all pairs i ≤ j, row after row.
template <class Visit>
void each_pair(const PairCounts& counts, Visit&& visit) {
    for (std::size_t shard = 0; shard < counts.shards(); ++shard) {
        const CountRows& rows = counts.rows(shard);
        for (std::size_t row = 0; row < rows.rows(); ++row)
            for (std::uint64_t k = rows.start[row]; k < rows.start[row + 1]; ++k)
                visit(shard * counts.shard_nodes() + row, rows.column[k], rows.count[k]);
    }
}

}  // namespace

SparseRows take_rows(PairCounts& counts) {
    const std::size_t n = counts.nodes();
    SparseRows all;
    all.start.assign(n + 1, 0);
    each_pair(counts, [&](std::size_t i, std::size_t j, std::uint64_t) {
        ++all.start[i + 1];
        all.start[j + 1] += j != i;
    });
    for (std::size_t i = 0; i < n; ++i)
        all.start[i + 1] += all.start[i];
    all.column.resize(all.start.back());
    all.value.resize(all.start.back());
    // Row after row: what stands left of a diagonal has come from the rows before, in order.
    std::vector<std::uint64_t> at(all.start.begin(), all.start.end() - 1);
    auto place = [&](std::size_t i, std::size_t j, double value) {
        all.column[at[i]] = static_cast<std::uint32_t>(j);
        all.value[at[i]++] = value;
    };
    each_pair(counts, [&](std::size_t i, std::size_t j, std::uint64_t count) {
        const auto value = static_cast<double>(count);
        place(i, j, j == i ? 2 * value : value);
        if (j != i)
            place(j, i, value);
    });
    for (std::size_t shard = 0; shard < counts.shards(); ++shard)
        counts.release(shard);
    return all;
}

void add_to_diagonal(const std::vector<double>& what, SparseRows& rows) {
    SparseRows result;
    result.column.reserve(rows.column.size());
    result.value.reserve(rows.column.size());
    for (std::size_t i = 0; i < rows.rows(); ++i) {
        bool placed = what[i] == 0;
        for (std::uint64_t k = rows.start[i]; k <= rows.start[i + 1]; ++k) {
            const bool end = k == rows.start[i + 1];
            double value = end ? 0 : rows.value[k];
            if (!placed && (end || rows.column[k] >= i)) {
                const bool there = !end && rows.column[k] == i;
                value += there ? what[i] : 0;
                if (!there) {
                    result.column.push_back(static_cast<std::uint32_t>(i));
                    result.value.push_back(what[i]);
                }
                placed = true;
            }
            if (!end) {
                result.column.push_back(rows.column[k]);
                result.value.push_back(value);
            }
        }
        result.start.push_back(result.column.size());
    }
    rows = std::move(result);
}

}  // namespace parallux
