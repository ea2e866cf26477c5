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

#include "lines/ball.h"
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

// atan2(y, x) by a polynomial to 2e-8 (M. Abramowitz and I. Stegun, Handbook of Mathematical
// Functions, 1964, 4.4.49) and a float's rounding.
template <class D>
HWY_INLINE hn::Vec<D> angle_of(D d, hn::Vec<D> y, hn::Vec<D> x) {
    const hn::Vec<D> up = hn::Abs(y), along = hn::Abs(x), half_turn = hn::Set(d, 3.14159265f);
    const hn::Vec<D> most = hn::Max(hn::Max(up, along), hn::Set(d, 1e-30f));
    const hn::Vec<D> a = hn::Div(hn::Min(up, along), most), square = hn::Mul(a, a);
    constexpr float c[] = {0.0028662257f, -0.0161657367f, 0.0429096138f, -0.0752896400f,
                           0.1065626393f, -0.1420889944f, 0.1999355085f, -0.3333314528f};
    hn::Vec<D> sum = hn::Set(d, c[0]);
    for (int k = 1; k < 8; ++k)
        sum = hn::Add(hn::Mul(sum, square), hn::Set(d, c[k]));
    hn::Vec<D> angle = hn::Mul(a, hn::Add(hn::Mul(sum, square), hn::Set(d, 1.0f)));
    angle = hn::IfThenElse(hn::Gt(up, along), hn::Sub(hn::Set(d, 1.57079633f), angle), angle);
    angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(half_turn, angle), angle);
    return hn::CopySign(angle, y);
}

// From the ends of a row of a sphere a line's depth is √(way from the left · way from the right),
// which loses no digits near the outline.
template <class D>
HWY_INLINE hn::Vec<D> ball_half(D d, const BallRow& row, hn::Vec<D> x, std::int32_t column,
                                hn::Vec<D>& aside) {
    const hn::Vec<D> left = hn::Add(hn::Add(x, hn::Set(d, static_cast<float>(column - row.begin))),
                                    hn::Set(d, row.before));
    const hn::Vec<D> right = hn::Add(
        hn::Sub(hn::Set(d, static_cast<float>(row.end - 1 - column)), x), hn::Set(d, row.beyond));
    aside = hn::Mul(hn::Set(d, 0.5f), hn::Sub(left, right));
    return hn::Sqrt(hn::Max(hn::Mul(left, right), hn::Zero(d)));
}

// hits_of() on half of a sphere.
template <class D>
HWY_NOINLINE Hits<D> ball_hits(D d, const SurfaceView& view, hn::Vec<D> x, float y) {
    const Projection::Ball& ball = *view.ball;
    const std::int32_t line_row = view.row + static_cast<std::int32_t>(y);
    hn::Vec<D> aside;
    hn::Vec<D> half = ball_half(d, row_of(ball, line_row), x, view.column, aside);
    if (!view.far)
        half = hn::Neg(half);
    Hits<D> hits;
    hits.depth = hn::Add(hn::Set(d, static_cast<float>(ball.depth)),
                         hn::Mul(half, hn::Set(d, static_cast<float>(ball.per_spacing))));
    hits.cell = hn::Zero(hn::RebindToSigned<D>());
    if (view.nu * view.nv == 1)
        return hits;
    const float down = static_cast<float>(line_row - ball.y);
    auto own = [&](int axis) {
        const hn::Vec<D> across = hn::Mul(hn::Set(d, ball.axes[0][axis]), aside);
        return hn::Add(hn::Add(across, hn::Set(d, ball.axes[1][axis] * down)),
                       hn::Mul(hn::Set(d, ball.axes[2][axis]), half));
    };
    const hn::Vec<D> px = own(0), py = own(1), pz = own(2);
    const hn::Vec<D> zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const hn::Vec<D> from_axis = hn::Sqrt(hn::Add(hn::Mul(px, px), hn::Mul(py, py)));
    const hn::Vec<D> u =
        hn::Add(hn::Mul(angle_of(d, pz, from_axis), hn::Set(d, 0.318309886f)), hn::Set(d, 0.5f));
    hn::Vec<D> v = hn::Mul(angle_of(d, py, px), hn::Set(d, 0.159154943f));
    v = hn::IfThenElse(hn::Lt(v, zero), hn::Add(v, one), v);
    if (ball.turned)
        v = hn::Sub(one, v);
    hits.cell = cell_of(d, view, hn::Min(hn::Max(u, zero), one), hn::Min(hn::Max(v, zero), one));
    return hits;
}

// The hits of lines at x columns and y rows from the view's own.
template <class D>
HWY_INLINE Hits<D> hits_of(D d, const SurfaceView& view, hn::Vec<D> x, float y) {
    if (view.ball)
        return ball_hits(d, view, x, y);
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
