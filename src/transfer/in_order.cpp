#include <algorithm>
#include <cmath>
#include <vector>

#include "parallux/transfer.h"
#include "transfer/for_bands.h"

// M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity (LSI-93-37-R, 1993): the loop over
// the pairs of an intersection list, and its bidirectional form.

namespace parallux {

namespace {

template <std::uint32_t bands>
struct InOrder {
    TransferState& state;
    Bank& bank;
    const Patches& patches;
    LineCounts& counts;

    struct Arrival {
        std::uint32_t patch;
        std::int64_t energy[bands];
    };
    std::vector<Arrival> waiting = {};

    std::int64_t* received(std::uint32_t patch) {
        return &bank.received[static_cast<std::size_t>(patch) * lanes(bands)];
    }

    // All that a patch has to send or has sent of what arrived, k = patch * bands + band.
    std::int64_t leaving(std::size_t k) {
        return scattered_quanta(patches, k, [&](std::size_t at) {
            return received(static_cast<std::uint32_t>(at / bands))[at % bands];
        });
    }

    // Takes all that a patch has to send: its unshot energy and the emission of one exit.
    void leave(std::uint32_t patch, std::int64_t* energy) {
        std::int64_t* own = received(patch);
        ++own[bands];
        std::size_t k = static_cast<std::size_t>(patch) * bands;
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::int64_t emission = std::llrint(state.emission.of_exit(patches, k + band));
            std::int64_t all = leaving(k + band);
            energy[band] = all - state.sent[k + band] + emission;
            state.emitted[band] += emission;
            state.sent[k + band] = all;
        }
    }

    // What comes through a surface must not go on along the line that brought it, as if that had
    // not been scattered: where light does, it arrives when the line is over.
    void arrive(std::uint32_t patch, const std::int64_t* energy) {
        if (!patches.translucent())
            return take(patch, energy);
        waiting.push_back({patch, {}});
        std::copy_n(energy, bands, waiting.back().energy);
    }

    void end_line() {
        for (const Arrival& one : waiting)
            take(one.patch, one.energy);
        waiting.clear();
    }

    void take(std::uint32_t patch, const std::int64_t* energy) {
        std::int64_t* own = received(patch);
        std::size_t k = static_cast<std::size_t>(patch) * bands;
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::int64_t before = passed_on(patches, k + band, own[band]);
            own[band] += energy[band];
            state.absorbed[band] +=
                energy[band] - (passed_on(patches, k + band, own[band]) - before);
        }
    }

    // Energy that meets nothing, or an inert back, goes no further.
    void escape(std::uint32_t patch) {
        std::int64_t energy[bands];
        leave(patch, energy);
        for (std::uint32_t band = 0; band < bands; ++band)
            state.escaped[band] += energy[band];
    }

    void sky(std::uint32_t patch, const std::int64_t* energy) {
        for (std::uint32_t band = 0; band < bands; ++band)
            state.sky[band] += energy[band];
        arrive(patch, energy);
    }

    void send(std::uint32_t i, std::uint32_t j) {
        if (i == none)
            return;
        if (j == none) {
            escape(i);
            ++counts.met_backs;
            return;
        }
        std::int64_t energy[bands];
        leave(i, energy);
        arrive(j, energy);
    }

    // Both send what they had before: neither sends on what the other has just sent.
    void swap(std::uint32_t i, std::uint32_t j) {
        if (i == none || j == none) {
            send(i, j);
            send(j, i);
            return;
        }
        std::int64_t to_j[bands], to_i[bands];
        leave(i, to_j);
        leave(j, to_i);
        arrive(j, to_j);
        arrive(i, to_i);
    }

    void follow(const Hit* hits, std::size_t count, bool both_ways, const SkyQuanta* outside) {
        // What leaves the scene leaves before the sky shines in.
        std::uint32_t first = hits[0].toward, last = hits[count - 1].away;
        if (both_ways && first != none)
            escape(first);
        if (outside && first != none)
            sky(first, outside->along);
        for (std::size_t k = 0; k + 1 < count; ++k) {
            std::uint32_t i = hits[k].away, j = hits[k + 1].toward;
            if (i != none && j != none)
                ++counts.transfers;
            if (both_ways)
                swap(i, j);
            else
                send(i, j);
        }
        if (last != none)
            escape(last);
        if (outside && both_ways && last != none)
            sky(last, outside->against);
        end_line();
    }
};

}  // namespace

void exchange_in_order(const IntersectionLists& lists, TransferState& state, Bank& bank,
                       const Patches& patches, Direction direction, std::span<const SkyQuanta> sky,
                       LineCounts& counts) {
    bool both_ways = direction == Direction::bidirectional;
    counts.lines += lists.lines();
    counts.hits += lists.hits.size();
    for_bands(state.bands, [&](auto bands) {
        InOrder<bands()> in_order{state, bank, patches, counts};
        for (std::size_t line = 0; line < lists.lines(); ++line) {
            std::uint32_t begin = lists.start[line], count = lists.start[line + 1] - begin;
            if (count == 0)
                continue;
            ++counts.nonempty;
            counts.odd += count % 2;
            const SkyQuanta* outside = sky.empty() ? nullptr : &sky[sky.size() == 1 ? 0 : line];
            in_order.follow(&lists.hits[begin], count, both_ways, outside);
        }
    });
}

}  // namespace parallux
