#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/painter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "lines/painter.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;

// Elementwise the arithmetic of place_at(), depth_at() and cell_at(), in the same order and without
// fused products, so that every instruction set gives the same bits.
struct Hits {
    VF depth;
    VI cell;
};

HWY_INLINE VI cell_of(const SurfaceView& view, VF u, VF v) {
    const Floats d;
    const Ints i;
    const VI most_u = hn::Set(i, static_cast<std::int32_t>(view.nu) - 1);
    const VF fu = hn::Mul(u, hn::Set(d, static_cast<float>(view.nu)));
    const VF fv = hn::Mul(v, hn::Set(d, static_cast<float>(view.nv)));
    VI iu = hn::Min(hn::ConvertTo(i, fu), most_u);
    const VI iv = hn::Min(hn::ConvertTo(i, fv), hn::Set(i, static_cast<std::int32_t>(view.nv) - 1));
    const VI n = hn::Set(i, static_cast<std::int32_t>(view.nu));
    if (view.shape == Shape::parallelogram)
        return hn::Add(hn::Mul(iv, n), iu);
    const VI one = hn::Set(i, 1), in_row = hn::Sub(n, iv);
    iu = hn::Min(iu, hn::Sub(in_row, one));
    const VF rest = hn::Add(hn::Sub(fu, hn::ConvertTo(d, iu)), hn::Sub(fv, hn::ConvertTo(d, iv)));
    const auto beyond = hn::RebindMask(i, hn::Gt(rest, hn::Set(d, 1.0f)));
    const auto inverted = hn::And(beyond, hn::Lt(hn::Add(iu, one), in_row));
    const VI k = hn::Add(hn::Add(iu, iu), hn::IfThenElseZero(inverted, one));
    return hn::Add(hn::Mul(iv, hn::Sub(hn::Add(n, n), iv)), k);
}

HWY_INLINE Hits hits_of(const SurfaceView& view, VF x, float y) {
    const Floats d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const float u_row = view.u_row * y, v_row = view.v_row * y;
    VF u = hn::Add(hn::Set(d, view.u),
                   hn::Add(hn::Mul(hn::Set(d, view.u_column), x), hn::Set(d, u_row)));
    VF v = hn::Add(hn::Set(d, view.v),
                   hn::Add(hn::Mul(hn::Set(d, view.v_column), x), hn::Set(d, v_row)));
    u = hn::Min(hn::Max(u, zero), one);
    v = hn::Min(hn::Max(v, zero), one);
    Hits hits;
    hits.depth = hn::Add(hn::Set(d, view.depth), hn::Add(hn::Mul(hn::Set(d, view.depth_u), u),
                                                         hn::Mul(hn::Set(d, view.depth_v), v)));
    hits.cell = view.nu * view.nv > 1 ? cell_of(view, u, v) : hn::Zero(Ints());
    return hits;
}

template <class Mask>
HWY_INLINE void append(PatchList& list, VI patches, Mask which) {
    const Ints i;
    // Not CompressStore: its form to memory takes a hundred cycles on some processors.
    hn::StoreU(hn::Compress(patches, which), i,
               reinterpret_cast<std::int32_t*>(list.ids.data()) + list.count);
    list.count += hn::CountTrue(i, which);
}

// The patch of either side, as a signed number; the absent side's is no_patch.
HWY_INLINE VI patch_of(std::uint32_t first, VI cell) {
    const Ints i;
    return first == none ? hn::Set(i, RowState::no_patch)
                         : hn::Add(hn::Set(i, static_cast<std::int32_t>(first)), cell);
}

void follow_span(const SurfaceView& view, const RowSpan& span, std::int32_t column,
                 std::int32_t row, bool skip, RowState& state, TilePairs& pairs, VI& any_unsure) {
    const Floats d;
    const Ints i;
    const std::int32_t lanes = static_cast<std::int32_t>(hn::Lanes(d));
    const float y = static_cast<float>(row - view.row);
    const VI zero = hn::Zero(i), outside = hn::Set(i, RowState::outside);
    const VF slack = hn::Set(d, view.slack);
    for (std::int32_t c = span.begin; c < span.end; c += lanes) {
        const Hits hits = hits_of(view, hn::ConvertTo(d, hn::Iota(i, column + c - view.column)), y);
        const auto inside = hn::FirstN(i, static_cast<std::size_t>(span.end - c));
        auto which = inside;
        const VI unsure = hn::LoadU(i, &state.unsure[c]);
        if (skip)
            which = hn::And(which, hn::Eq(unsure, zero));
        // Only a step of more than both slacks is certain.
        const VF step = hn::Sub(hits.depth, hn::LoadU(d, &state.depth[c]));
        const VF needed = hn::Add(slack, hn::LoadU(d, &state.slack[c]));
        if (!skip) {
            const auto uncertain = hn::And(which, hn::Not(hn::RebindMask(i, hn::Ge(step, needed))));
            const VI marked = hn::Or(unsure, hn::IfThenElseZero(uncertain, hn::Set(i, 1)));
            hn::StoreU(marked, i, &state.unsure[c]);
            any_unsure = hn::Or(any_unsure, hn::IfThenElseZero(uncertain, hn::Set(i, 1)));
        }
        const VI previous = hn::LoadU(i, &state.last[c]);
        const auto from_patch = hn::And(which, hn::Gt(previous, hn::Set(i, RowState::no_patch)));
        if (view.toward == none) {
            if (!hn::AllFalse(i, from_patch))
                append(pairs.into_backs, previous, from_patch);
        } else {
            const VI toward = patch_of(view.toward, hits.cell);
            const std::size_t before = pairs.from.count;
            append(pairs.from, previous, from_patch);
            append(pairs.to, toward, from_patch);
            const auto rest = hn::AndNot(from_patch, which);
            if (pairs.from.count - before < static_cast<std::size_t>(lanes) &&
                !hn::AllFalse(i, rest)) {
                const auto first = hn::And(rest, hn::Eq(previous, outside));
                append(pairs.first, toward, first);
                append(pairs.from_backs, toward, hn::AndNot(first, rest));
            }
        }
        hn::BlendedStore(patch_of(view.away, hits.cell), which, i, &state.last[c]);
        const auto which_floats = hn::RebindMask(d, which);
        hn::BlendedStore(hits.depth, which_floats, d, &state.depth[c]);
        hn::BlendedStore(slack, which_floats, d, &state.slack[c]);
        const VI odd = hn::Xor(hn::LoadU(i, &state.odd[c]), hn::Set(i, 1));
        hn::BlendedStore(odd, which, i, &state.odd[c]);
        pairs.hits += hn::CountTrue(i, which);
    }
}

// What is left to look at beyond the last surface.
void end_row(std::int32_t columns, RowState& state, TilePairs& pairs) {
    const Ints i;
    const std::int32_t lanes = static_cast<std::int32_t>(hn::Lanes(i));
    const VI zero = hn::Zero(i), outside = hn::Set(i, RowState::outside);
    for (std::int32_t c = 0; c < columns; c += lanes) {
        const auto inside = hn::FirstN(i, static_cast<std::size_t>(columns - c));
        const VI last = hn::LoadU(i, &state.last[c]);
        const auto out = hn::And(inside, hn::Gt(last, hn::Set(i, RowState::no_patch)));
        if (!hn::AllFalse(i, out))
            append(pairs.last, last, out);
        pairs.nonempty += hn::CountTrue(i, hn::And(inside, hn::Ne(last, outside)));
        const VI odd = hn::LoadU(i, &state.odd[c]);
        pairs.odd += hn::CountTrue(i, hn::And(inside, hn::Ne(odd, zero)));
    }
}

bool paint(const SurfaceView* views, const RowSpan* spans, std::size_t count, std::int32_t column,
           std::int32_t row, std::int32_t columns, bool skip, RowState& state, TilePairs& pairs) {
    const Ints i;
    VI any_unsure = hn::Zero(i);
    for (std::size_t k = 0; k < count; ++k)
        follow_span(views[spans[k].view], spans[k], column, row, skip, state, pairs, any_unsure);
    if (!hn::AllFalse(i, hn::Ne(any_unsure, hn::Zero(i))))
        return true;
    end_row(columns, state, pairs);
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

HWY_EXPORT(paint);

bool paint_row(const SurfaceView* views, const RowSpan* spans, std::size_t count,
               std::int32_t column, std::int32_t row, std::int32_t columns, bool skip,
               RowState& state, TilePairs& pairs) {
    return HWY_DYNAMIC_DISPATCH(paint)(views, spans, count, column, row, columns, skip, state,
                                       pairs);
}

}  // namespace parallux
#endif
