#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallux/transfer.h"

namespace parallux {

/// One end of a pair: patch `to` receives what `from` carries, and is left by the line itself.
struct Half {
    std::uint32_t to, from;
};

/// Lets one bank serve any number of workers without locks, where banks of their own would take too
/// much: workers put the halves of their tiles' pairs into buckets, one a range of patches, and
/// after a round of tiles every range is added up by one of them. Sums of integers are the same in
/// whatever order. Memory: about 8 MiB a worker.
class Partition {
public:
    Partition(std::size_t patches, std::uint32_t bands, unsigned workers);

    /// How many tiles are to be put before the next apply().
    std::size_t tiles_a_round() const { return tiles_a_round_; }

    /// As exchange_pairs(), but that the bank gets its share with apply(). Different workers may
    /// put at once.
    void put(unsigned worker, const TilePairs& pairs, const TransferState& state,
             Direction direction, const SkyQuanta* sky, WorkerTotals& totals);

    /// Adds what was put to the bank, in parallel. Until then what exits carry may not change.
    void apply(const TransferState& state, Bank& bank, unsigned threads);

    /// About what it takes.
    static std::uint64_t bytes(unsigned workers) { return workers * (std::uint64_t(9) << 20); }

    /// Set in `to`: the line does not leave there. Set in `from`: the rest counts what comes from
    /// outside the exchange.
    static constexpr std::uint32_t marked = 1u << 31;

    /// The open end of a bucket.
    struct Bucket {
        Half *next = nullptr, *end = nullptr;
        std::vector<std::uint32_t> chunks;  ///< filled before, and this one
    };

    /// One worker's buckets.
    struct alignas(64) Store {
        std::vector<Bucket> buckets;
        std::vector<std::vector<Half>> chunks;
        std::size_t used = 0;           ///< of the chunks
        std::size_t densest = 1 << 14;  ///< most halves of a tile so far; as many at least
        /// Records as in TransferState::carried: nothing, then what came from the sky.
        AlignedArray<std::int32_t> outside;
        std::uint32_t range_bits = 0;

        void begin_chunk(Bucket& bucket);
        void put(std::uint32_t to, std::uint32_t from) {
            Bucket& bucket = buckets[(to & ~marked) >> range_bits];
            if (bucket.next == bucket.end)
                begin_chunk(bucket);
            *bucket.next++ = {to, from};
        }
    };

private:
    std::uint32_t add_outside(Store& store, const std::int64_t* sky) const;
    void apply_range(std::size_t range, const TransferState& state, Bank& bank);

    std::uint32_t bands_;
    std::size_t tiles_a_round_;
    std::vector<Store> stores_;
};

}  // namespace parallux
