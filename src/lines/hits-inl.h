// Patches and depths of many lines at once, for the vector code of each instruction set:
// elementwise the arithmetic of place_at(), depth_at() and cell_at(), in the same order and without
// fused products, so that every instruction set gives the same bits.

#if defined(PARALLUX_LINES_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_LINES_HITS_INL_H_
#undef PARALLUX_LINES_HITS_INL_H_
#else
#define PARALLUX_LINES_HITS_INL_H_
#endif

#include <hwy/highway.h>

#include "lines/squeezed_lanes.h"
#include "lines/surface_view.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A line's hit on a surface; `cell` of the surface's grid.
template <class D>
struct Hits {
    hn::Vec<D> depth;
    hn::Vec<hn::RebindToSigned<D>> cell;
};

template <class D>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> cell_of(D d, const SurfaceView& view, hn::Vec<D> u,
                                                  hn::Vec<D> v) {
    const hn::RebindToSigned<D> i;
    using Cells = hn::Vec<decltype(i)>;
    const Cells most_u = hn::Set(i, static_cast<std::int32_t>(view.nu) - 1);
    const hn::Vec<D> fu = hn::Mul(u, hn::Set(d, static_cast<float>(view.nu)));
    const hn::Vec<D> fv = hn::Mul(v, hn::Set(d, static_cast<float>(view.nv)));
    Cells iu = hn::Min(hn::ConvertTo(i, fu), most_u);
    const Cells iv =
        hn::Min(hn::ConvertTo(i, fv), hn::Set(i, static_cast<std::int32_t>(view.nv) - 1));
    const Cells n = hn::Set(i, static_cast<std::int32_t>(view.nu));
    if (view.shape == Shape::parallelogram)
        return hn::Add(hn::Mul(iv, n), iu);
    const Cells one = hn::Set(i, 1), in_row = hn::Sub(n, iv);
    iu = hn::Min(iu, hn::Sub(in_row, one));
    const hn::Vec<D> rest =
        hn::Add(hn::Sub(fu, hn::ConvertTo(d, iu)), hn::Sub(fv, hn::ConvertTo(d, iv)));
    const auto beyond = hn::RebindMask(i, hn::Gt(rest, hn::Set(d, 1.0f)));
    const auto inverted = hn::And(beyond, hn::Lt(hn::Add(iu, one), in_row));
    const Cells k = hn::Add(hn::Add(iu, iu), hn::IfThenElseZero(inverted, one));
    return hn::Add(hn::Mul(iv, hn::Sub(hn::Add(n, n), iv)), k);
}

// The hits of lines at x columns and y rows from the view's own.
template <class D>
HWY_INLINE Hits<D> hits_of(D d, const SurfaceView& view, hn::Vec<D> x, float y) {
    const hn::Vec<D> zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const float u_row = view.u_row * y, v_row = view.v_row * y;
    hn::Vec<D> u = hn::Add(hn::Set(d, view.u),
                           hn::Add(hn::Mul(hn::Set(d, view.u_column), x), hn::Set(d, u_row)));
    hn::Vec<D> v = hn::Add(hn::Set(d, view.v),
                           hn::Add(hn::Mul(hn::Set(d, view.v_column), x), hn::Set(d, v_row)));
    u = hn::Min(hn::Max(u, zero), one);
    v = hn::Min(hn::Max(v, zero), one);
    Hits<D> hits;
    hits.depth = hn::Add(hn::Set(d, view.depth), hn::Add(hn::Mul(hn::Set(d, view.depth_u), u),
                                                         hn::Mul(hn::Set(d, view.depth_v), v)));
    hits.cell = view.nu * view.nv > 1 ? cell_of(d, view, u, v) : hn::Zero(hn::RebindToSigned<D>());
    return hits;
}

// The lanes of `which` first, the others after them.
template <class V, class M>
HWY_INLINE V squeeze(V v, M which) {
#if HWY_TARGET == HWY_AVX2
    // Highway's own form copies its table to the stack at every call.
    const hn::DFromV<V> d;
    const hn::Rebind<std::uint8_t, hn::DFromV<V>> d8;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, which, bits);
    const auto lanes =
        hn::PromoteTo(hn::RebindToSigned<decltype(d)>(), hn::LoadU(d8, squeezed_lanes.of[bits[0]]));
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes));
#else
    return hn::Compress(v, which);
#endif
}

// Appends those patches of `which` to a list. The place must have room for a whole vector.
template <class V, class M>
HWY_INLINE std::size_t append(std::uint32_t* place, V patches, M which) {
    const hn::DFromV<V> d;
    // Not CompressStore: its form to memory takes a hundred cycles on some processors.
    hn::StoreU(squeeze(patches, which), d, reinterpret_cast<hn::TFromV<V>*>(place));
    return hn::CountTrue(d, which);
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
