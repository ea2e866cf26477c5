#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "view_factors/pair_table.h"

namespace parallux {

/// How many lines join each two nodes, and each node and the outside, in groups whose spread tells
/// the error. Workers put counts into buffers of their own, dealt to shards of nodes; apply() adds
/// up each shard by one worker. Integers all through: no order of work changes the result.
class PairCounts {
public:
    static constexpr std::uint32_t shards = 64;

    PairCounts(std::size_t nodes, std::uint32_t outsides, unsigned threads);

    /// Lines between i and j; j ≥ nodes: from i to outside j - nodes. For the worker alone.
    void put(unsigned worker, std::uint32_t i, std::uint32_t j, std::uint32_t count) {
        if (i > j)
            std::swap(i, j);
        buffers_[worker].shard[i % shards].push_back({i, j, count});
    }
    /// What buffers hold, in entries.
    std::uint64_t buffered() const;
    /// Takes up what buffers hold.
    void apply(unsigned threads);
    /// Ends a group: its spread counts, and the next one begins.
    void end_group(unsigned threads);

    /// Pairs of nodes so far, and those of them that one and that two lines of the group join.
    struct Pairs {
        std::uint64_t all = 0, once = 0, twice = 0;
    };
    Pairs pairs();
    std::uint64_t table_bytes() const;

    std::size_t nodes() const { return exits_.size(); }
    std::uint32_t outsides() const { return outsides_; }
    std::uint32_t groups() const { return groups_; }
    /// Lines that left each node in all groups.
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

    /// The places of the nodes i with i % shards == shard; key = i << 32 | j, i ≤ j.
    PairTable& table(std::uint32_t shard) { return tables_[shard]; }

private:
    struct Entry {
        std::uint32_t i, j, count;
    };
    struct alignas(64) Buffers {
        std::vector<Entry> shard[shards];
    };
    void apply_shard(std::uint32_t shard);
    void sum_rows(unsigned threads, std::vector<std::uint64_t>& exits);
    void take_shares(unsigned threads, const std::vector<std::uint64_t>& exits);

    std::uint32_t outsides_, groups_ = 0;
    std::vector<Buffers> buffers_;
    std::vector<PairTable> tables_;
    std::vector<std::uint64_t> outside_, outside_now_, exits_;
    Shares outside_shares_, sky_shares_;
    std::vector<double> squares_;
};

}  // namespace parallux
