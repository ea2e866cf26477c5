#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "view_factors/count_rows.h"

namespace parallux {

/// How many lines join each two nodes, and each node and the outside, in groups whose spread tells
/// the error. Workers put counts into lists of their own, dealt to shards of neighbouring nodes;
/// apply() adds up each shard by one worker. Integers all through: no order of work changes the
/// result.
class PairCounts {
public:
    static constexpr std::uint64_t line = 64;  ///< what a line counts that weighs 1

    PairCounts(std::size_t nodes, std::uint32_t outsides, unsigned threads);

    /// Lines between i and j; j ≥ nodes: from i to outside j - nodes. For the worker alone.
    void put(unsigned worker, std::uint32_t i, std::uint32_t j, std::uint64_t lines) {
        if (i > j)
            std::swap(i, j);
        append(lists_[worker].shard[i >> row_bits_], i & ((1u << row_bits_) - 1), j, line * lines);
    }
    /// Ends a bundle, of which workers first … last - 1 have put all since they ended one: its
    /// lines get weights from how many there should be (line_weight()): between i and j the root of
    /// the product of both, to the outside that of i. Without `expected` all weigh 1.
    void end_bundle(unsigned first, unsigned last, const std::vector<double>& expected);
    /// What lists hold, in entries, and how many are worth to be taken up: as rows are copied for
    /// it, in proportion to these.
    std::uint64_t listed() const;
    std::uint64_t enough() const;
    /// Takes up what lists hold; of bundles that are to be weighed only after their end.
    void apply(unsigned threads);
    /// Ends a group: its spread counts, and the next one begins.
    void end_group(unsigned threads);

    /// Pairs of nodes that lines have joined: in the first group so far; later, in all before.
    std::uint64_t pairs() const;
    std::uint64_t bytes() const;

    std::size_t nodes() const { return exits_.size(); }
    std::uint32_t outsides() const { return outsides_; }
    std::uint32_t groups() const { return groups_; }
    /// What left each node in all groups.
    const std::vector<std::uint64_t>& exits() const { return exits_; }
    /// node · outsides + outside.
    const std::vector<std::uint64_t>& outside() const { return outside_; }
    /// Of all groups, the sum of the shares f = n_ik / n_i of a group, and of their squares; `sky`
    /// of all but the last two outsides together.
    struct Shares {
        std::vector<double> sum, squares;
    };
    const Shares& outside_shares() const { return outside_shares_; }
    const Shares& sky_shares() const { return sky_shares_; }
    /// Of each row, Σ_j Σ_groups n_ij².
    const std::vector<double>& squares() const { return squares_; }

    /// All groups' counts n_ij, i ≤ j, of the nodes from shard · shard_nodes() on.
    std::size_t shards() const { return shards_.size(); }
    std::size_t shard_nodes() const { return std::size_t(1) << row_bits_; }
    const CountRows& rows(std::size_t shard) const { return shards_[shard].before; }
    void release(std::size_t shard) { shards_[shard] = {}; }

private:
    struct alignas(64) Lists {
        std::vector<std::vector<std::uint64_t>> shard;
        std::vector<std::size_t> ended;  // of each shard, entries of bundles that have ended
        std::vector<std::uint64_t> met;  // what left each node in a bundle
        std::vector<double> weight;      // of its lines there
    };
    void append(std::vector<std::uint64_t>& list, std::uint32_t row, std::uint32_t column,
                std::uint64_t count) const {
        for (; count > packing_.most(); count -= packing_.most())
            list.push_back(packing_.pack(row, column, packing_.most()));
        list.push_back(packing_.pack(row, column, count));
    }
    void find_weights(unsigned first, unsigned last, const std::vector<double>& expected);
    struct Shard {
        CountRows current, before;  // of this group, outsides among the columns; of those before
    };
    void sum_rows(unsigned threads, std::vector<std::uint64_t>& exits);
    void take_shares(unsigned threads, const std::vector<std::uint64_t>& exits);
    template <class Visit>
    void each_row(std::size_t shard, const CountRows& rows, Visit&& visit) const;

    std::uint32_t outsides_, groups_ = 0;
    unsigned row_bits_;
    PackedCount packing_;
    std::vector<Lists> lists_;
    std::vector<RowAdder> adders_;
    std::vector<Shard> shards_;
    std::vector<std::uint64_t> outside_, exits_;
    Shares outside_shares_, sky_shares_;
    std::vector<double> squares_;
};

}  // namespace parallux
