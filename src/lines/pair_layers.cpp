#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/pair_layers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "lines/hit_layers.h"
#include "lines/hits-inl.h"
#include "lines/line_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// Without vectors every line goes the plain way.
void pair_all(const MeshTile& tile, HitLayers& layers, ViewCache&, const KeyTies&, TilePairs&,
              std::vector<std::int32_t>& left) {
    for (std::int32_t row = 0; row < tile.bounds.rows(); ++row)
        for (std::int32_t column = 0; column < tile.bounds.columns(); ++column)
            if (std::int32_t line = row * HitLayers::side + column; layers.counts()[line] > 0)
                left.push_back(line);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

// Lines are followed as many at a time as a vector has 32-bit lanes; their keys fill two vectors.
using Keys = hn::RepartitionToWide<Ints>;  // no key has the highest bit
using VK = hn::Vec<Keys>;

// The sorted hits of neighbouring lines of a row, and how many each has.
struct LineHits {
    VK low[HitLayers::layers], high[HitLayers::layers];  // keys of the first and second half
    VI count;
    std::uint32_t most;
};

// K. E. Batcher, Sorting networks and their applications, 1968: odd-even merge sort.
template <std::uint32_t count>
HWY_INLINE void sort_network(VK* k) {
    if constexpr (count > 2) {
        sort_network<count / 2>(k);
        sort_network<count / 2>(k + count / 2);
    }
    for (std::uint32_t step = count / 2; step > 0; step /= 2)
        for (std::uint32_t a = step == count / 2 ? 0 : step; a + step < count; a += 2 * step)
            for (std::uint32_t b = a; b < a + step; ++b) {
                const VK low = hn::Min(k[b], k[b + step]);
                k[b + step] = hn::Max(k[b], k[b + step]);
                k[b] = low;
            }
}

template <std::uint32_t count>
HWY_INLINE void load_half(HitLayers& layers, std::int32_t line, VK own, VK* keys) {
    const Keys d;
    const VK far = hn::Set(d, INT64_MAX);
    for (std::uint32_t n = 0; n < count; ++n) {
        const VK key = hn::Load(d, reinterpret_cast<const std::int64_t*>(layers.keys(n)) + line);
        keys[n] = hn::IfThenElse(hn::Gt(own, hn::Set(d, n)), key, far);
    }
    if constexpr (count > 1)
        sort_network<count>(keys);
}

template <std::uint32_t count>
HWY_INLINE void load_sorted(HitLayers& layers, std::int32_t line, LineHits& hits) {
    const Keys d;
    load_half<count>(layers, line, hn::PromoteTo(d, hn::LowerHalf(hits.count)), hits.low);
    load_half<count>(layers, line + static_cast<std::int32_t>(hn::Lanes(d)),
                     hn::PromoteTo(d, hn::UpperHalf(hn::Half<Ints>(), hits.count)), hits.high);
}

HWY_INLINE void load_lines(HitLayers& layers, std::int32_t line, LineHits& hits) {
    if (hits.most <= 2)
        load_sorted<2>(layers, line, hits);
    else if (hits.most <= 4)
        load_sorted<4>(layers, line, hits);
    else if (hits.most <= 8)
        load_sorted<8>(layers, line, hits);
    else
        load_sorted<16>(layers, line, hits);
}

// Upper halves of two vectors of keys.
HWY_INLINE VI upper_halves(VK low, VK high) {
    const Ints i;
    return hn::ConcatOdd(i, hn::BitCast(i, high), hn::BitCast(i, low));
}
HWY_INLINE VI lower_halves(VK low, VK high) {
    const Ints i;
    return hn::ConcatEven(i, hn::BitCast(i, high), hn::BitCast(i, low));
}

// The pairs of neighbouring lines.
struct LinePairs {
    const MeshTile& tile;
    const std::int64_t* sides;
    ViewCache& views;
    TilePairs& pairs;

    HWY_INLINE void follow(const LineHits& hits, std::int32_t column, std::int32_t row) {
        const Ints i;
        const VI nobody = hn::Set(i, -1), one = hn::Set(i, 1);
        VI previous = nobody;
        for (std::uint32_t n = 0; n < hits.most; ++n) {
            const Lines met = hn::Gt(hits.count, hn::Set(i, static_cast<std::int32_t>(n)));
            const VI id = hn::IfThenElseZero(met, lower_halves(hits.low[n], hits.high[n]));
            VI toward, away;
            sides_of(id, toward, away);
            const Lines divided = hn::Ne(hn::And(id, one), hn::Zero(i));
            if (!hn::AllFalse(i, divided))
                add_cells(id, divided, column, row, toward, away);
            const Lines to_patch = hn::And(met, hn::Ne(toward, nobody));
            if (n == 0)
                put(pairs.first, toward, to_patch);
            else
                pair(previous, toward, met, to_patch);
            // What leaves the last surface leaves the scene.
            put(pairs.last, away,
                hn::And(hn::Eq(hits.count, hn::Set(i, static_cast<std::int32_t>(n + 1))),
                        hn::Ne(away, nobody)));
            previous = away;
        }
    }

private:
    HWY_INLINE void sides_of(VI id, VI& toward, VI& away) const {
        const Keys d;
        const hn::Half<Ints> half;
        const VI view = hn::ShiftRight<1>(id);
        const VK low = hn::GatherIndex(d, sides, hn::PromoteTo(d, hn::LowerHalf(view)));
        const VK high = hn::GatherIndex(d, sides, hn::PromoteTo(d, hn::UpperHalf(half, view)));
        toward = lower_halves(low, high);
        away = upper_halves(low, high);
    }

    HWY_INLINE void pair(VI previous, VI toward, Lines met, Lines to_patch) {
        const Ints i;
        const Lines from_patch = hn::And(met, hn::Ne(previous, hn::Set(i, -1)));
        const Lines both = hn::And(from_patch, to_patch);
        append(pairs.from.ids.data() + pairs.from.count, previous, both);
        pairs.to.count += append(pairs.to.ids.data() + pairs.to.count, toward, both);
        pairs.from.count = pairs.to.count;
        put(pairs.into_backs, previous, hn::AndNot(to_patch, from_patch));
        put(pairs.from_backs, toward, hn::AndNot(from_patch, to_patch));
    }

    static HWY_INLINE void put(PatchList& list, VI patches, Lines which) {
        if (!hn::AllFalse(Ints(), which))
            list.count += append(list.ids.data() + list.count, patches, which);
    }

    // The cells of hits on surfaces of more than one patch, one surface after the other: most often
    // neighbouring lines meet the same.
    HWY_INLINE void add_cells(VI id, Lines divided, std::int32_t column, std::int32_t row,
                              VI& toward, VI& away) {
        const Ints i;
        const Floats f;
        const VI nobody = hn::Set(i, -1);
        alignas(64) std::int32_t ids[16];
        hn::Store(id, i, ids);
        VI cell = hn::Zero(i);
        for (std::uint32_t bits = bits_of(divided); bits != 0;) {
            const std::int32_t own = ids[std::countr_zero(bits)];
            const SurfaceView& view =
                views.of(tile, static_cast<std::size_t>(static_cast<std::uint32_t>(own) >> 1));
            const auto x =
                hn::ConvertTo(f, hn::Add(hn::Iota(i, 0), hn::Set(i, column - view.column)));
            const Lines same = hn::Eq(id, hn::Set(i, own));
            cell = hn::IfThenElse(
                same, hits_of(f, view, x, static_cast<float>(row - view.row)).cell, cell);
            bits &= ~bits_of(same);
        }
        toward = hn::Add(toward, hn::IfThenElseZero(hn::Ne(toward, nobody), cell));
        away = hn::Add(away, hn::IfThenElseZero(hn::Ne(away, nobody), cell));
    }
};

// Lines whose successive hits are nearer to each other than the tie.
HWY_INLINE Lines near_ties(const LineHits& hits, VI tie) {
    const Ints i;
    Lines near = hn::FirstN(i, 0);
    VI before = upper_halves(hits.low[0], hits.high[0]);
    for (std::uint32_t n = 1; n < hits.most; ++n) {
        const VI depth = upper_halves(hits.low[n], hits.high[n]);
        near = hn::Or(near, hn::And(hn::Gt(hits.count, hn::Set(i, static_cast<std::int32_t>(n))),
                                    hn::Lt(hn::Sub(depth, before), tie)));
        before = depth;
    }
    return near;
}

// Orders again the hits of lines whose depths do not tell.
HWY_NOINLINE void order_ties(const KeyTies& ties, std::uint32_t lines, std::int32_t line,
                             LineHits& hits) {
    const Ints i;
    const Keys d;
    const std::size_t lanes = hn::Lanes(i);
    alignas(64) HitKey keys[HitLayers::layers][16];
    alignas(64) std::int32_t count[16];
    hn::Store(hits.count, i, count);
    auto place = [&](std::uint32_t n) { return reinterpret_cast<std::int64_t*>(keys[n]); };
    for (std::uint32_t n = 0; n < hits.most; ++n) {
        hn::Store(hits.low[n], d, place(n));
        hn::Store(hits.high[n], d, place(n) + lanes / 2);
    }
    for (; lines != 0; lines &= lines - 1) {
        const int lane = std::countr_zero(lines);
        ties.order(&keys[0][lane], 16, static_cast<std::uint32_t>(count[lane]), line + lane);
    }
    for (std::uint32_t n = 0; n < hits.most; ++n) {
        hits.low[n] = hn::Load(d, place(n));
        hits.high[n] = hn::Load(d, place(n) + lanes / 2);
    }
}

// Counts of hits of neighbouring lines; those that go the plain way are handed back with none.
HWY_INLINE VI counts_of(HitLayers& layers, std::int32_t line, std::uint32_t& left) {
    const Ints i;
    const hn::Rebind<std::uint8_t, Ints> d8;
    const VI count = hn::PromoteTo(i, hn::LoadU(d8, layers.counts() + line));
    const VI marks = hn::PromoteTo(i, hn::LoadU(d8, layers.unsure() + line));
    const VI zero = hn::Zero(i);
    const Lines unsure =
        hn::And(hn::Gt(count, zero),
                hn::Or(hn::Gt(marks, zero), hn::Gt(count, hn::Set(i, HitLayers::layers))));
    left = bits_of(unsure);
    return hn::IfThenElse(unsure, zero, count);
}

HWY_INLINE std::uint32_t most_of(VI count) {
    std::uint32_t most = 0;
    while (!hn::AllFalse(Ints(), hn::Gt(count, hn::Set(Ints(), static_cast<std::int32_t>(most)))))
        ++most;
    return most;
}

void pair_all(const MeshTile& tile, HitLayers& layers, ViewCache& views, const KeyTies& ties,
              TilePairs& pairs, std::vector<std::int32_t>& left) {
    const Ints i;
    const std::int32_t lanes = static_cast<std::int32_t>(hn::Lanes(i));
    const VI zero = hn::Zero(i), one = hn::Set(i, 1);
    const VI tie =
        hn::Set(i, static_cast<std::int32_t>(static_cast<double>(tile.tie) * key_depth_one) + 1);
    LinePairs line_pairs{tile, reinterpret_cast<const std::int64_t*>(layers.sides()), views, pairs};
    VI hits_sum = zero, odd_sum = zero, nonempty_sum = zero;
    for (std::int32_t y = 0; y < tile.bounds.rows(); ++y)
        for (std::int32_t x = 0; x < tile.bounds.columns(); x += lanes) {
            const std::int32_t line = y * HitLayers::side + x;
            LineHits hits;
            std::uint32_t skipped = 0;
            hits.count = counts_of(layers, line, skipped);
            for (; skipped != 0; skipped &= skipped - 1)
                left.push_back(line + std::countr_zero(skipped));
            hits.most = most_of(hits.count);
            if (hits.most == 0)
                continue;
            load_lines(layers, line, hits);
            const Lines near = near_ties(hits, tie);
            if (!hn::AllFalse(i, near))
                order_ties(ties, bits_of(near), line, hits);
            line_pairs.follow(hits, tile.bounds.left + x, tile.bounds.top + y);
            hits_sum = hn::Add(hits_sum, hits.count);
            odd_sum = hn::Add(odd_sum, hn::And(hits.count, one));
            nonempty_sum = hn::Add(nonempty_sum, hn::IfThenElseZero(hn::Gt(hits.count, zero), one));
        }
    auto total = [&](VI sum) {
        return static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(i, sum)));
    };
    pairs.hits += total(hits_sum);
    pairs.odd += total(odd_sum);
    pairs.nonempty += total(nonempty_sum);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

HWY_EXPORT(pair_all);

void pair_layers(const MeshTile& tile, HitLayers& layers, ViewCache& views, const KeyTies& ties,
                 TilePairs& pairs, std::vector<std::int32_t>& left) {
    HWY_DYNAMIC_DISPATCH(pair_all)(tile, layers, views, ties, pairs, left);
}

Hit KeyTies::hit(HitKey key) const {
    const std::size_t view = static_cast<std::uint32_t>(key) >> 1;
    const std::uint32_t surface = tile_.surfaces[view];
    slack_[surface] = layers_.moved(view);
    const double depth = static_cast<double>(key >> 32) / key_depth_one - key_depth_zero;
    const std::uint64_t sides = layers_.sides()[view];
    return {static_cast<float>(depth), surface, static_cast<std::uint32_t>(sides),
            static_cast<std::uint32_t>(sides >> 32)};
}

void KeyTies::order(HitKey* keys, std::size_t stride, std::uint32_t count,
                    std::int32_t line) const {
    const TieOrder order(tile_.projection, tile_.scene, tile_.patches, centre_,
                         tile_.bounds.left + line % HitLayers::side,
                         tile_.bounds.top + line / HitLayers::side, slack_, relations_);
    const std::int64_t tie = key_tie(tile_);
    for (std::uint32_t k = 1; k < count; ++k) {
        const HitKey key = keys[k * stride];
        std::uint32_t place = k;
        for (; place > 0; --place) {
            const HitKey other = keys[(place - 1) * stride];
            if (static_cast<std::int64_t>(key >> 32) - static_cast<std::int64_t>(other >> 32) >=
                    tie ||
                !order.before(hit(key), hit(other)))
                break;
            keys[place * stride] = other;
        }
        keys[place * stride] = key;
    }
}

}  // namespace parallux
#endif
