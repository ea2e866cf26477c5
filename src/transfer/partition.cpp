#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/partition.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include <algorithm>

#include "parallel.h"
#include "transfer/count_lines.h"
#include "transfer/for_bands.h"
#include "transfer/partition.h"
#include "transfer/send-inl.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

// Both halves of every pair. Neighbours on a tile's row mostly go to one range: then all at once.
void put_pairs(const PatchList& from, const PatchList& to, Partition::Store& store) {
    const hn::CappedTag<std::uint32_t, 8> d;
    const std::size_t step = hn::Lanes(d);
    const int bits = static_cast<int>(store.range_bits);
    auto put_all = [&](const std::uint32_t* ends, const std::uint32_t* others) HWY_ATTR {
        const auto e = hn::LoadU(d, ends), o = hn::LoadU(d, others);
        const auto range = hn::Set(d, ends[0] >> bits);
        Partition::Bucket& bucket = store.buckets[ends[0] >> bits];
        if (hn::AllTrue(d, hn::Eq(hn::ShiftRightSame(e, bits), range)) &&
            static_cast<std::size_t>(bucket.end - bucket.next) >= step) {
            hn::StoreInterleaved2(e, o, d, &bucket.next->to);
            bucket.next += step;
        } else {
            for (std::size_t k = 0; k < step; ++k)
                store.put(ends[k], others[k]);
        }
    };
    const std::uint32_t *i = from.ids.data(), *j = to.ids.data();
    std::size_t k = 0;
    for (; k + step <= from.count; k += step) {
        put_all(j + k, i + k);
        put_all(i + k, j + k);
    }
    for (; k < from.count; ++k) {
        store.put(j[k], i[k]);
        store.put(i[k], j[k]);
    }
}

void apply_halves(std::uint32_t band_count, const Half* halves, std::size_t count,
                  const std::int32_t* carried, const std::int32_t* outside,
                  std::int64_t* received) {
    constexpr std::size_t ahead = 64;
    for_bands(band_count, [&](auto bands) HWY_ATTR {
        constexpr std::size_t width = lanes(bands());
        auto source = [&](std::uint32_t from) HWY_ATTR {
            return from < Partition::marked ? carried + from * width
                                            : outside + (from - Partition::marked) * width;
        };
        auto target = [&](std::uint32_t to)
                          HWY_ATTR { return received + (to & ~Partition::marked) * width; };
        for (std::size_t k = 0; k < count; ++k) {
            if (k + ahead < count) {
                hwy::Prefetch(source(halves[k + ahead].from));
                hwy::Prefetch(target(halves[k + ahead].to));
            }
            send<bands()>(source(halves[k].from), target(halves[k].to),
                          halves[k].to < Partition::marked ? 1 : 0);
        }
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

namespace {

HWY_EXPORT(put_pairs);
HWY_EXPORT(apply_halves);

constexpr std::size_t halves_a_chunk = 512;
constexpr std::size_t halves_a_worker = 1 << 20;

// Ranges of which the bank's share stays in a worker's cache, but never so many that their open
// chunks take more than the halves do.
std::uint32_t range_bits_for(std::size_t patches) {
    std::uint32_t bits = 15;
    while ((patches - 1) >> bits >= halves_a_worker / halves_a_chunk / 2)
        ++bits;
    return bits;
}

}  // namespace

Partition::Partition(std::size_t patches, std::uint32_t bands, unsigned workers)
    : bands_(bands), tiles_a_round_(workers), stores_(workers) {
    for (Store& store : stores_) {
        store.range_bits = range_bits_for(patches);
        store.buckets.resize(((patches - 1) >> store.range_bits) + 1);
        store.outside.assign(lanes(bands), 0);
    }
}

void Partition::Store::begin_chunk(Bucket& bucket) {
    if (used == chunks.size())
        chunks.emplace_back(halves_a_chunk);
    bucket.next = chunks[used].data();
    bucket.end = bucket.next + halves_a_chunk;
    bucket.chunks.push_back(static_cast<std::uint32_t>(used++));
}

std::uint32_t Partition::add_outside(Store& store, const std::int64_t* sky) const {
    const std::size_t place = store.outside.size();
    store.outside.resize(place + lanes(bands_), 0);
    for (std::uint32_t band = 0; band < bands_; ++band)
        store.outside[place + band] = static_cast<std::int32_t>(sky[band]);
    return marked + static_cast<std::uint32_t>(place / lanes(bands_));
}

void Partition::put(unsigned worker, const TilePairs& pairs, const TransferState& state,
                    Direction direction, const SkyQuanta* sky, WorkerTotals& totals) {
    const bool both_ways = direction == Direction::bidirectional;
    count_lines(pairs, state, both_ways, sky, totals);
    Store& store = stores_[worker];
    store.densest = std::max(store.densest,
                             2 * (pairs.from.count + pairs.first.count + pairs.into_backs.count));
    constexpr std::uint32_t nothing = marked;
    auto put_all = [&](const PatchList& patches, std::uint32_t mark, std::uint32_t from) {
        for (std::size_t k = 0; k < patches.count; ++k)
            store.put(patches.ids[k] | mark, from);
    };
    const std::uint32_t along = sky ? add_outside(store, sky->along) : nothing;
    put_all(pairs.into_backs, 0, nothing);
    if (both_ways) {
        HWY_DYNAMIC_DISPATCH(put_pairs)(pairs.from, pairs.to, store);
        put_all(pairs.from_backs, 0, nothing);
        put_all(pairs.first, 0, along);
        put_all(pairs.last, 0, sky ? add_outside(store, sky->against) : nothing);
        return;
    }
    for (std::size_t k = 0; k < pairs.from.count; ++k) {
        store.put(pairs.to.ids[k] | marked, pairs.from.ids[k]);
        store.put(pairs.from.ids[k], nothing);
    }
    put_all(pairs.last, 0, nothing);
    if (sky)
        put_all(pairs.first, marked, along);
}

void Partition::apply_range(std::size_t range, const TransferState& state, Bank& bank) {
    for (Store& store : stores_) {
        Bucket& bucket = store.buckets[range];
        for (std::uint32_t number : bucket.chunks) {
            const Half* halves = store.chunks[number].data();
            const bool open = number == bucket.chunks.back();
            HWY_DYNAMIC_DISPATCH(apply_halves)
            (bands_, halves, open ? static_cast<std::size_t>(bucket.next - halves) : halves_a_chunk,
             state.carried.data(), store.outside.data(), bank.received.data());
        }
        bucket.next = bucket.end = nullptr;
        bucket.chunks.clear();
    }
}

void Partition::apply(const TransferState& state, Bank& bank, unsigned threads) {
    parallel_for(threads, stores_[0].buckets.size(), 1,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t range = begin; range < end; ++range)
                         apply_range(range, state, bank);
                 });

    // A round's tiles may all be as dense as the densest so far.
    std::size_t densest = 1;
    for (Store& store : stores_) {
        densest = std::max(densest, store.densest);
        store.used = 0;
        store.outside.resize(lanes(bands_));
    }
    tiles_a_round_ = std::max(stores_.size(), halves_a_worker * stores_.size() / densest);
}

}  // namespace parallux
#endif
