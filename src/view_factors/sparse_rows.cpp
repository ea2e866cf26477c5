#include "view_factors/sparse_rows.h"

#include <algorithm>

#include "parallel.h"

namespace parallux {

namespace {

// Each row's entries on and right of the diagonal; a shard's rows lie in its table alone.
SparseRows upper_triangle(PairCounts& counts, unsigned threads) {
    constexpr std::uint32_t shards = PairCounts::shards;
    SparseRows upper;
    upper.start.assign(counts.nodes() + 1, 0);
    auto each_place = [&](std::uint32_t shard, auto&& visit) {
        for (const PairTable::Place& place : counts.table(shard).places())
            if (place.key != PairTable::empty)
                visit(place.key >> 32, place);
    };
    parallel_for(threads, shards, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t shard = begin; shard < end; ++shard)
            each_place(static_cast<std::uint32_t>(shard),
                       [&](std::size_t i, const PairTable::Place&) { ++upper.start[i + 1]; });
    });
    for (std::size_t i = 0; i < counts.nodes(); ++i)
        upper.start[i + 1] += upper.start[i];
    upper.column.resize(upper.start.back());
    upper.value.resize(upper.start.back());
    parallel_for(threads, shards, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t shard = begin; shard < end; ++shard) {
            PairTable& table = counts.table(static_cast<std::uint32_t>(shard));
            std::vector<PairTable::Place>& places = table.places();
            std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
                return a.key < b.key;  // empty places come last
            });
            std::uint64_t row = counts.nodes(), at = 0;
            each_place(static_cast<std::uint32_t>(shard),
                       [&](std::size_t i, const PairTable::Place& place) {
                           at = i == row ? at + 1 : upper.start[i];
                           row = i;
                           upper.column[at] = static_cast<std::uint32_t>(place.key);
                           upper.value[at] = static_cast<double>(place.before);
                       });
            table.release();
        }
    });
    return upper;
}

}  // namespace

SparseRows take_rows(PairCounts& counts, unsigned threads) {
    const SparseRows upper = upper_triangle(counts, threads);
    const std::size_t n = upper.rows();
    SparseRows all;
    all.start.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::uint64_t k = upper.start[i]; k < upper.start[i + 1]; ++k) {
            ++all.start[i + 1];
            all.start[upper.column[k] + 1] += upper.column[k] != i;
        }
    for (std::size_t i = 0; i < n; ++i)
        all.start[i + 1] += all.start[i];
    all.column.resize(all.start.back());
    all.value.resize(all.start.back());
    // Row after row: what stands left of a diagonal has come from the rows before, in order.
    std::vector<std::uint64_t> at(all.start.begin(), all.start.end() - 1);
    for (std::size_t i = 0; i < n; ++i)
        for (std::uint64_t k = upper.start[i]; k < upper.start[i + 1]; ++k) {
            const std::uint32_t j = upper.column[k];
            const double value = j == i ? 2 * upper.value[k] : upper.value[k];
            all.column[at[i]] = j;
            all.value[at[i]++] = value;
            if (j != i) {
                all.column[at[j]] = static_cast<std::uint32_t>(i);
                all.value[at[j]++] = value;
            }
        }
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
