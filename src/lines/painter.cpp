#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/painter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstring>
#include <limits>

#include "lines/hits-inl.h"
#include "lines/line_lanes-inl.h"
#include "lines/painter.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::int32_t no_patch = -1;  // an inert back
constexpr std::int32_t outside = -2;   // nothing yet

HWY_INLINE Lines lines_of(std::uint32_t bits) {
    std::uint8_t bytes[8] = {};
    std::memcpy(bytes, &bits, sizeof bits);
    return hn::LoadMaskBits(Ints(), bytes);
}

HWY_INLINE void append_to(PatchList& list, VI patches, Lines which) {
    list.count += append(list.ids.data() + list.count, patches, which);
}

// The patch of either side, as a signed number; the absent side's is no_patch.
HWY_INLINE VI patch_of(std::uint32_t first, VI cell) {
    const Ints i;
    return first == none ? hn::Set(i, no_patch)
                         : hn::Add(hn::Set(i, static_cast<std::int32_t>(first)), cell);
}

// What the lines of a block met last.
struct Front {
    VI last;  // patch that looks along the direction
    VF depth, slack;
};

// Pairs the lines of one surface with what they met last.
HWY_INLINE void meet(const SurfaceView& view, const Hits<Floats>& hits, Lines which, Front& front,
                     TilePairs& pairs) {
    const Ints i;
    const auto from_patch = hn::And(which, hn::Gt(front.last, hn::Set(i, no_patch)));
    if (view.toward == none) {
        if (!hn::AllFalse(i, from_patch))
            append_to(pairs.into_backs, front.last, from_patch);
    } else {
        const VI toward = patch_of(view.toward, hits.cell);
        hn::StoreU(squeeze(front.last, from_patch), i,
                   reinterpret_cast<std::int32_t*>(pairs.from.ids.data()) + pairs.from.count);
        append_to(pairs.to, toward, from_patch);
        pairs.from.count = pairs.to.count;
        const auto rest = hn::AndNot(from_patch, which);
        if (!hn::AllFalse(i, rest)) {
            const auto first = hn::And(rest, hn::Eq(front.last, hn::Set(i, outside)));
            append_to(pairs.first, toward, first);
            append_to(pairs.from_backs, toward, hn::AndNot(first, rest));
        }
    }
    front.last = hn::IfThenElse(which, patch_of(view.away, hits.cell), front.last);
}

// Some neighbouring lines of a row, from `column`; bit 0 of the spans' lines, shifted, is the
// first. Lines of `skip` are left out. Returns those whose order is not certain; what was paired is
// then to be dropped.
HWY_INLINE std::uint32_t paint_lines(const SurfaceView* views, const BlockSpan* begin,
                                     const BlockSpan* end, std::int32_t column, std::int32_t row,
                                     int shift, std::uint32_t skip, TilePairs& pairs) {
    const Floats d;
    const Ints i;
    const std::uint32_t all = (1u << hn::Lanes(i)) - 1;
    Front front = {hn::Set(i, outside), hn::Set(d, -std::numeric_limits<float>::infinity()),
                   hn::Zero(d)};
    std::uint32_t unsure = 0, met = 0, odd = 0;
    for (const BlockSpan* span = begin; span != end; ++span) {
        const std::uint32_t bits = (span->lines >> shift) & all & ~skip;
        if (bits == 0)
            continue;
        met |= bits;
        odd ^= bits;
        const SurfaceView& view = views[span->view];
        const Lines which = lines_of(bits);
        const Hits<Floats> hits = hits_of(
            d, view, hn::ConvertTo(d, hn::Add(hn::Iota(i, 0), hn::Set(i, column - view.column))),
            static_cast<float>(row - view.row));
        // Only a step of more than both slacks is certain.
        const VF step = hn::Sub(hits.depth, front.depth), slack = hn::Set(d, view.slack);
        const auto certain = hn::RebindMask(i, hn::Ge(step, hn::Add(slack, front.slack)));
        if (!hn::AllFalse(i, hn::AndNot(certain, which)))
            unsure |= bits_of(hn::AndNot(certain, which));
        meet(view, hits, which, front, pairs);
        const auto which_floats = hn::RebindMask(d, which);
        front.depth = hn::IfThenElse(which_floats, hits.depth, front.depth);
        front.slack = hn::IfThenElse(which_floats, slack, front.slack);
    }
    if (unsure != 0)
        return unsure;
    // What leaves the last surface leaves the scene.
    const auto out = hn::Gt(front.last, hn::Set(i, no_patch));
    if (!hn::AllFalse(i, out))
        append_to(pairs.last, front.last, out);
    pairs.nonempty += static_cast<std::uint64_t>(std::popcount(met));
    pairs.odd += static_cast<std::uint64_t>(std::popcount(odd));
    return 0;
}

void paint_tile(const SurfaceView* views, const BlockLists& lists, const TileBounds& bounds,
                TilePairs& pairs, std::vector<UnsureLines>& unsure) {
    const int lanes = static_cast<int>(hn::Lanes(Ints()));
    std::size_t block = 0;
    for (std::int32_t row = bounds.top; row < bounds.bottom; ++row)
        for (std::int32_t column = bounds.left; column < bounds.right;
             column += block_lines, ++block) {
            const BlockSpan *begin = lists.begin(block), *end = lists.end(block);
            if (begin == end)
                continue;
            for (int shift = 0; shift < block_lines; shift += lanes) {
                TilePairs::Mark mark = pairs.mark();
                std::uint32_t skip =
                    paint_lines(views, begin, end, column + shift, row, shift, 0, pairs);
                if (skip == 0)
                    continue;
                // Once more without the lines that are unsure.
                pairs.back_to(mark);
                paint_lines(views, begin, end, column + shift, row, shift, skip, pairs);
                unsure.push_back({block, skip << shift});
            }
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

HWY_EXPORT(paint_tile);

void paint(const SurfaceView* views, const BlockLists& lists, const TileBounds& bounds,
           TilePairs& pairs, std::vector<UnsureLines>& unsure) {
    HWY_DYNAMIC_DISPATCH(paint_tile)(views, lists, bounds, pairs, unsure);
}

void BlockLists::reset(const TileBounds& bounds, std::size_t views) {
    blocks_ = (bounds.columns() + block_lines - 1) / block_lines;
    capacity_ = views;
    hits_ = 0;
    std::size_t blocks =
        static_cast<std::size_t>(bounds.rows()) * static_cast<std::size_t>(blocks_);
    count_.assign(blocks, 0);
    if (spans_.size() < blocks * views)
        spans_.resize(blocks * views);
}

}  // namespace parallux
#endif
