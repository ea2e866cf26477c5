#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/exchange_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include <atomic>

#include "parallux/transfer.h"
#include "transfer/for_bands.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Adds what an exit carries, and behind the bands the exit itself.
template <std::uint32_t bands>
HWY_INLINE void send(const std::int32_t* HWY_RESTRICT carried,
                     std::int64_t* HWY_RESTRICT received) {
    constexpr std::uint32_t count = lanes(bands);
    const hn::CappedTag<std::int64_t, count == 12 ? 4 : count> d;
    const hn::Rebind<std::int32_t, decltype(d)> half;
    for (std::size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
        auto sent = hn::PromoteTo(d, hn::Load(half, carried + lane));
        if (lane <= bands && bands < lane + hn::Lanes(d))
            sent = hn::IfThenElse(
                hn::Eq(hn::Iota(d, 0), hn::Set(d, static_cast<std::int64_t>(bands - lane))),
                hn::Set(d, 1), sent);
        hn::Store(hn::Add(hn::Load(d, received + lane), sent), d, received + lane);
    }
}

// Both of every pair receive what the other carries, and the exit that it is counted by.
template <std::uint32_t bands>
void exchange_both(const PatchList& from, const PatchList& to, const std::int32_t* carried,
                   std::int64_t* received) {
    constexpr std::size_t ahead = 16, count = lanes(bands);
    const std::uint32_t *i = from.ids.data(), *j = to.ids.data();
    for (std::size_t k = 0; k < from.count; ++k) {
        const std::size_t a = i[k] * count, b = j[k] * count;
        if (k + ahead < from.count) {
            const std::size_t next_a = i[k + ahead] * count, next_b = j[k + ahead] * count;
            hwy::Prefetch(carried + next_a);
            hwy::Prefetch(carried + next_b);
            hwy::Prefetch(received + next_a);
            hwy::Prefetch(received + next_b);
        }
        send<bands>(carried + a, received + b);
        send<bands>(carried + b, received + a);
    }
}

void exchange_lanes(std::uint32_t band_count, const PatchList& from, const PatchList& to,
                    const std::int32_t* carried, std::int64_t* received) {
    for_bands(band_count, [&](auto bands) { exchange_both<bands()>(from, to, carried, received); });
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

namespace {

HWY_EXPORT(exchange_lanes);

template <bool shared>
void add_to(std::int64_t& target, std::int64_t value) {
    if constexpr (shared)
        std::atomic_ref<std::int64_t>(target).fetch_add(value, std::memory_order_relaxed);
    else
        target += value;
}

template <std::uint32_t bands, bool shared>
struct PairExchange {
    const std::int32_t* quanta;
    std::int64_t* received;
    WorkerTotals& totals;

    std::size_t at(std::uint32_t patch) const {
        return static_cast<std::size_t>(patch) * lanes(bands);
    }

    void one_way(const PatchList& from, const PatchList& to) {
        for (std::size_t k = 0; k < from.count; ++k) {
            const std::size_t i = at(from.ids[k]), j = at(to.ids[k]);
            for (std::uint32_t band = 0; band < bands; ++band)
                add_to<shared>(received[j + band], std::int64_t(quanta[i + band]));
            add_to<shared>(received[i + bands], 1);
        }
    }

    // Energy that meets nothing, or an inert back, goes no further.
    void escape(const PatchList& patches) {
        std::int64_t sums[bands] = {};
        for (std::size_t k = 0; k < patches.count; ++k) {
            const std::size_t i = at(patches.ids[k]);
            for (std::uint32_t band = 0; band < bands; ++band)
                sums[band] += quanta[i + band];
            add_to<shared>(received[i + bands], 1);
        }
        for (std::uint32_t band = 0; band < bands; ++band)
            totals.escaped[band] += sums[band];
    }

    void shine(const PatchList& patches, const std::int64_t* sky) {
        for (std::size_t k = 0; k < patches.count; ++k)
            for (std::uint32_t band = 0; band < bands; ++band)
                add_to<shared>(received[at(patches.ids[k]) + band], sky[band]);
        for (std::uint32_t band = 0; band < bands; ++band)
            totals.sky[band] += sky[band] * static_cast<std::int64_t>(patches.count);
    }
};

template <std::uint32_t bands, bool shared>
void exchange_all(const TilePairs& pairs, const TransferState& state, bool both_ways,
                  const SkyQuanta* sky, Bank& bank, WorkerTotals& totals) {
    PairExchange<bands, shared> exchange{state.carried.data(), bank.received.data(), totals};
    if (both_ways && !shared) {
        HWY_DYNAMIC_DISPATCH(exchange_lanes)
        (bands, pairs.from, pairs.to, state.carried.data(), bank.received.data());
    } else {
        exchange.one_way(pairs.from, pairs.to);
        if (both_ways)
            exchange.one_way(pairs.to, pairs.from);
    }
    exchange.escape(pairs.last);
    exchange.escape(pairs.into_backs);
    totals.counts.met_backs += pairs.into_backs.count;
    if (both_ways) {
        exchange.escape(pairs.first);
        exchange.escape(pairs.from_backs);
        totals.counts.met_backs += pairs.from_backs.count;
    }
    if (sky)
        exchange.shine(pairs.first, sky->along);
    if (sky && both_ways)
        exchange.shine(pairs.last, sky->against);
}

}  // namespace

void exchange_pairs(const TilePairs& pairs, const TransferState& state, Direction direction,
                    const SkyQuanta* sky, Bank& bank, bool shared, WorkerTotals& totals) {
    LineCounts& counts = totals.counts;
    counts.lines += pairs.lines;
    counts.nonempty += pairs.nonempty;
    counts.hits += pairs.hits;
    counts.odd += pairs.odd;
    counts.transfers += pairs.from.count;
    bool both_ways = direction == Direction::bidirectional;
    for_bands(state.bands, [&](auto bands) {
        if (shared)
            exchange_all<bands(), true>(pairs, state, both_ways, sky, bank, totals);
        else
            exchange_all<bands(), false>(pairs, state, both_ways, sky, bank, totals);
    });
}

}  // namespace parallux
#endif
