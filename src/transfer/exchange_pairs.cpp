#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/exchange_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "transfer/count_lines.h"
#include "transfer/for_bands.h"
#include "transfer/send-inl.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

// Both of every pair receive what the other carries, and the exit that it is counted by. Patches
// `ahead` pairs further on are asked for early; 0: they are near enough. With 1.2 million patches
// 256 is 1.7 times as fast as 16, and the fastest of those tried.
template <std::uint32_t bands, std::size_t ahead>
void exchange_both(const PatchList& from, const PatchList& to, const std::int32_t* carried,
                   std::int64_t* received) {
    constexpr std::size_t count = lanes(bands);
    const std::uint32_t *i = from.ids.data(), *j = to.ids.data();
    for (std::size_t k = 0; k < from.count; ++k) {
        const std::size_t a = i[k] * count, b = j[k] * count;
        if (ahead > 0 && k + ahead < from.count) {
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

void exchange_lanes(std::uint32_t band_count, bool far, const PatchList& from, const PatchList& to,
                    const std::int32_t* carried, std::int64_t* received) {
    for_bands(band_count, [&](auto bands) {
        if (far)
            exchange_both<bands(), 256>(from, to, carried, received);
        else
            exchange_both<bands(), 0>(from, to, carried, received);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

namespace {

HWY_EXPORT(exchange_lanes);

// What lies beyond the caches near to the processor is asked for early.
constexpr std::size_t near_bytes = std::size_t(4) << 20;

template <std::uint32_t bands>
struct PairExchange {
    const std::int32_t* carried;
    std::int64_t* received;
    bool far;

    std::size_t at(std::uint32_t patch) const {
        return static_cast<std::size_t>(patch) * lanes(bands);
    }

    void one_way(const PatchList& from, const PatchList& to) const {
        for (std::size_t k = 0; k < from.count; ++k) {
            const std::size_t i = at(from.ids[k]), j = at(to.ids[k]);
            for (std::uint32_t band = 0; band < bands; ++band)
                received[j + band] += carried[i + band];
            ++received[i + bands];
        }
    }

    void leave(const PatchList& patches) const {
        for (std::size_t k = 0; k < patches.count; ++k)
            ++received[at(patches.ids[k]) + bands];
    }

    void shine(const PatchList& patches, const std::int64_t* sky) const {
        for (std::size_t k = 0; k < patches.count; ++k)
            for (std::uint32_t band = 0; band < bands; ++band)
                received[at(patches.ids[k]) + band] += sky[band];
    }
};

template <std::uint32_t bands>
void exchange_all(const TilePairs& pairs, const PairExchange<bands>& exchange, bool both_ways,
                  const SkyQuanta* sky) {
    if (both_ways) {
        HWY_DYNAMIC_DISPATCH(exchange_lanes)
        (bands, exchange.far, pairs.from, pairs.to, exchange.carried, exchange.received);
    } else {
        exchange.one_way(pairs.from, pairs.to);
    }
    exchange.leave(pairs.last);
    exchange.leave(pairs.into_backs);
    if (both_ways) {
        exchange.leave(pairs.first);
        exchange.leave(pairs.from_backs);
    }
    if (sky)
        exchange.shine(pairs.first, sky->along);
    if (sky && both_ways)
        exchange.shine(pairs.last, sky->against);
}

}  // namespace

void exchange_pairs(const TilePairs& pairs, const TransferState& state, Direction direction,
                    const SkyQuanta* sky, Bank& bank, WorkerTotals& totals) {
    const bool both_ways = direction == Direction::bidirectional;
    count_lines(pairs, state, both_ways, sky, totals);
    const std::size_t bytes = state.carried.size() * (sizeof(std::int32_t) + sizeof(std::int64_t));
    for_bands(state.bands, [&](auto bands) {
        const PairExchange<bands()> exchange{state.carried.data(), bank.received.data(),
                                             bytes > near_bytes};
        exchange_all(pairs, exchange, both_ways, sky);
    });
}

}  // namespace parallux
#endif
