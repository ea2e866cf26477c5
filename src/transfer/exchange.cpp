#include <atomic>

#include "parallux/transfer.h"
#include "transfer/for_bands.h"

namespace parallux {

LineCounts& LineCounts::operator+=(const LineCounts& other) {
    lines += other.lines;
    nonempty += other.nonempty;
    hits += other.hits;
    transfers += other.transfers;
    odd += other.odd;
    met_backs += other.met_backs;
    return *this;
}

namespace {

template <bool shared, class Integer>
void add(Integer& target, Integer value) {
    if constexpr (shared)
        std::atomic_ref<Integer>(target).fetch_add(value, std::memory_order_relaxed);
    else
        target += value;
}

// One worker's view of the energy during an exchange.
template <std::uint32_t bands, bool shared>
struct Exchange {
    const std::int32_t* quanta;
    Bank& bank;
    WorkerTotals& totals;

    void leave(std::uint32_t patch) {
        add<shared>(bank.received[static_cast<std::size_t>(patch) * lanes(bands) + bands],
                    std::int64_t(1));
    }

    template <class Quanta>
    void receive(std::uint32_t patch, const Quanta* energy) {
        std::int64_t* received = &bank.received[static_cast<std::size_t>(patch) * lanes(bands)];
        for (std::uint32_t band = 0; band < bands; ++band)
            add<shared>(received[band], std::int64_t(energy[band]));
    }

    const std::int32_t* carried(std::uint32_t patch) const {
        return quanta + static_cast<std::size_t>(patch) * lanes(bands);
    }

    // Energy that meets nothing, or an inert back, goes no further.
    void escape(std::uint32_t patch) {
        leave(patch);
        const std::int32_t* energy = carried(patch);
        for (std::uint32_t band = 0; band < bands; ++band)
            totals.escaped[band] += energy[band];
    }

    void sky(std::uint32_t patch, const std::int64_t* energy) {
        receive(patch, energy);
        for (std::uint32_t band = 0; band < bands; ++band)
            totals.sky[band] += energy[band];
    }

    // What leaves `from` arrives at `to`; either may be the inert back of a surface.
    void send(std::uint32_t from, std::uint32_t to) {
        if (from == none)
            return;
        if (to == none) {
            escape(from);
            ++totals.counts.met_backs;
            return;
        }
        leave(from);
        receive(to, carried(from));
    }

    void follow(const Hit* hits, std::size_t count, bool both_ways, const SkyQuanta* outside) {
        // The ends of the line lie outside: the sky shines in, what leaves has escaped.
        std::uint32_t first = hits[0].toward, last = hits[count - 1].away;
        if (outside && first != none)
            sky(first, outside->along);
        if (outside && both_ways && last != none)
            sky(last, outside->against);
        if (both_ways && first != none)
            escape(first);
        if (last != none)
            escape(last);
        for (std::size_t k = 0; k + 1 < count; ++k) {
            std::uint32_t i = hits[k].away, j = hits[k + 1].toward;
            if (i != none && j != none)
                ++totals.counts.transfers;
            send(i, j);
            if (both_ways)
                send(j, i);
        }
    }
};

template <std::uint32_t bands, bool shared>
void exchange_all(const IntersectionLists& lists, const TransferState& state, bool both_ways,
                  std::span<const SkyQuanta> sky, Bank& bank, WorkerTotals& totals) {
    Exchange<bands, shared> exchange{state.carried.data(), bank, totals};
    LineCounts& counts = totals.counts;
    counts.lines += lists.lines();
    counts.hits += lists.hits.size();
    for (std::size_t line = 0; line < lists.lines(); ++line) {
        std::uint32_t begin = lists.start[line], count = lists.start[line + 1] - begin;
        if (count == 0)
            continue;
        ++counts.nonempty;
        counts.odd += count % 2;
        const SkyQuanta* outside = sky.empty() ? nullptr : &sky[sky.size() == 1 ? 0 : line];
        exchange.follow(&lists.hits[begin], count, both_ways, outside);
    }
}

}  // namespace

void exchange(const IntersectionLists& lists, const TransferState& state, Direction direction,
              std::span<const SkyQuanta> sky, Bank& bank, bool shared, WorkerTotals& totals) {
    bool both_ways = direction == Direction::bidirectional;
    for_bands(state.bands, [&](auto bands) {
        if (shared)
            exchange_all<bands(), true>(lists, state, both_ways, sky, bank, totals);
        else
            exchange_all<bands(), false>(lists, state, both_ways, sky, bank, totals);
    });
}

}  // namespace parallux
