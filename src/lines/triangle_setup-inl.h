// What small triangles need to be filled, for as many at once as a vector has lanes.

#if defined(PARALLUX_LINES_TRIANGLE_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_LINES_TRIANGLE_SETUP_INL_H_
#undef PARALLUX_LINES_TRIANGLE_SETUP_INL_H_
#else
#define PARALLUX_LINES_TRIANGLE_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "lines/hit_layers.h"
#include "lines/line_lanes-inl.h"
#include "lines/small_surface.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

// As many successive views of a tile as a vector has lanes: what their small triangles need.
struct Triangles {
    alignas(64) std::int32_t at[3][16], per_column[3][16], per_row[3][16];
    alignas(64) float depth[16], depth_column[16], depth_row[16];
    alignas(64) std::int32_t line[16], width[16], height[16], id[16];
    std::uint32_t shaped[block_classes];  // which are small triangles of each class
    std::uint32_t other;                  // which are no small triangles, or steep ones
};

class TriangleSetup {
public:
    HWY_INLINE TriangleSetup(const MeshTile& tile, double steep)
        : tile_(tile),
          steep_(static_cast<float>(steep)),
          surfaces_(reinterpret_cast<const std::int32_t*>(tile.scene.surfaces.data())),
          corners_(reinterpret_cast<const std::int32_t*>(tile.projection.corners.data())),
          grids_(reinterpret_cast<const std::int32_t*>(tile.patches.grids.data())) {
        static_assert(sizeof(Surface) == 32 && offsetof(Surface, corner) == 0);
        static_assert(sizeof(Projection::Corner) == 12 && sizeof(SurfaceGrid) == 16);
    }

    HWY_INLINE void operator()(std::size_t view, Triangles& t, HitLayers& layers) const {
        const Ints i;
        const std::size_t count = std::min(tile_.count - view, hn::Lanes(i));
        const Lines present = hn::FirstN(i, count);
        alignas(64) std::int32_t own[16] = {};
        std::memcpy(own, tile_.surfaces + view, count * sizeof own[0]);
        const VI s = hn::Load(i, own);
        // Corners of triangles, as the lines from the box's first see them.
        VI x[3], y[3], depth[3];
        const VI surface = hn::ShiftLeft<3>(s);
        for (int k = 0; k < 3; ++k) {
            VI corner = hn::GatherIndex(i, surfaces_, hn::Add(surface, hn::Set(i, k)));
            corner = hn::Add(corner, hn::Add(corner, corner));
            x[k] = hn::GatherIndex(i, corners_, corner);
            y[k] = hn::GatherIndex(i, corners_, hn::Add(corner, hn::Set(i, 1)));
            depth[k] = hn::GatherIndex(i, corners_, hn::Add(corner, hn::Set(i, 2)));
        }
        const Lines triangle = hn::And(
            present,
            hn::Eq(hn::GatherIndex(i, surfaces_, hn::Add(surface, hn::Set(i, 3))), hn::Set(i, -1)));
        const Lines little = hn::And(triangle, box_of(x, y, t));
        const VI turned = hn::Sub(hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])),
                                  hn::Mul(hn::Sub(y[1], y[0]), hn::Sub(x[2], x[0])));
        const Lines along = hn::Gt(turned, hn::Zero(i));
        const Lines flat = planes(x, y, depth, turned, view, t, layers);
        t.other = bits_of(hn::AndNot(hn::And(little, flat), present));
        classify(hn::And(hn::And(little, flat), hn::Ne(turned, hn::Zero(i))), t);
        edges(x, y, along, t);
        sides(s, along, view, t, layers);
    }

private:
    // Clips the boxes of all lines to the tile, and counts x and y from them. Which are small?
    HWY_INLINE Lines box_of(VI* x, VI* y, Triangles& t) const {
        const Ints i;
        const VI low_x = hn::Min(hn::Min(x[0], x[1]), x[2]);
        const VI high_x = hn::Max(hn::Max(x[0], x[1]), x[2]);
        const VI low_y = hn::Min(hn::Min(y[0], y[1]), y[2]);
        const VI high_y = hn::Max(hn::Max(y[0], y[1]), y[2]);
        auto first = [&](VI fixed) {
            return hn::ShiftRight<fixed_bits>(hn::Add(fixed, hn::Set(i, fixed_one - 1)));
        };
        const TileBounds& bounds = tile_.bounds;
        const VI left = hn::Max(first(low_x), hn::Set(i, bounds.left));
        const VI top = hn::Max(first(low_y), hn::Set(i, bounds.top));
        hn::Store(hn::Sub(hn::Min(first(high_x), hn::Set(i, bounds.right)), left), i, t.width);
        hn::Store(hn::Sub(hn::Min(first(high_y), hn::Set(i, bounds.bottom)), top), i, t.height);
        static_assert(HitLayers::side == 64);
        hn::Store(hn::Add(hn::ShiftLeft<6>(hn::Sub(top, hn::Set(i, bounds.top))),
                          hn::Sub(left, hn::Set(i, bounds.left))),
                  i, t.line);
        for (int k = 0; k < 3; ++k) {
            x[k] = hn::Sub(x[k], hn::ShiftLeft<fixed_bits>(left));
            y[k] = hn::Sub(y[k], hn::ShiftLeft<fixed_bits>(top));
        }
        const VI most = hn::Set(i, small_extent * static_cast<std::int32_t>(fixed_one) + 1);
        return hn::And(hn::Lt(hn::Sub(high_x, low_x), most), hn::Lt(hn::Sub(high_y, low_y), most));
    }

    // Sorts those with lines in their box by the blocks that they take.
    static HWY_INLINE void classify(Lines small, Triangles& t) {
        const Ints i;
        const VI width = hn::Load(i, t.width), height = hn::Load(i, t.height);
        const VI zero = hn::Zero(i), one = hn::Set(i, 1);
        const Lines some = hn::And(small, hn::And(hn::Gt(width, zero), hn::Gt(height, zero)));
        const VI of_square = hn::ShiftRight<2>(hn::Sub(height, one));
        const VI of_wide = hn::Add(hn::ShiftRight<1>(hn::Sub(height, one)), hn::Set(i, 2));
        const VI shape = hn::IfThenElse(hn::Gt(width, hn::Set(i, 4)), of_wide, of_square);
        for (int k = 0; k < block_classes; ++k)
            t.shaped[k] = bits_of(hn::And(some, hn::Eq(shape, hn::Set(i, k))));
    }

    // Filler::plane_of() of many; which are not steep?
    HWY_INLINE Lines planes(const VI* x, const VI* y, const VI* depth, VI turned, std::size_t view,
                            Triangles& t, HitLayers& layers) const {
        const Ints i;
        const Floats f;
        const hn::Half<Ints> half;
        auto low = [&](VI v) { return hn::LowerHalf(half, v); };
        auto high = [&](VI v) { return hn::UpperHalf(half, v); };
        const std::size_t middle = hn::Lanes(i) / 2;
        for (std::size_t part : {std::size_t(0), middle}) {
            auto own = [&](VI v) { return part == 0 ? low(v) : high(v); };
            half_planes(own(x[0]), own(y[0]), own(hn::Sub(x[1], x[0])), own(hn::Sub(y[1], y[0])),
                        own(hn::Sub(x[2], x[0])), own(hn::Sub(y[2], y[0])), own(depth[0]),
                        own(depth[1]), own(depth[2]), own(turned), part, t);
        }
        const auto slope =
            hn::Add(hn::Abs(hn::Load(f, t.depth_column)), hn::Abs(hn::Load(f, t.depth_row)));
        constexpr float unit = static_cast<float>(1 / (key_depth_one * fixed_one));
        hn::StoreU(hn::Mul(slope, hn::Set(f, unit)), f, layers.moved() + view);
        return hn::RebindMask(i, hn::Le(slope, hn::Set(f, steep_)));
    }

    template <class V>
    static HWY_INLINE void half_planes(V x0, V y0, V x1, V y1, V x2, V y2, V depth0, V depth1,
                                       V depth2, V turned, std::size_t part, Triangles& t) {
        const hn::RepartitionToWide<Floats> d;
        const hn::Half<Floats> f;
        auto wide = [&](V v) { return hn::PromoteTo(d, v); };
        auto key = [&](V v) {
            return hn::Mul(hn::Add(hn::PromoteTo(d, hn::BitCast(f, v)), hn::Set(d, key_depth_zero)),
                           hn::Set(d, key_depth_one));
        };
        const auto inverse = hn::Div(hn::Set(d, static_cast<double>(fixed_one)), wide(turned));
        const auto d0 = key(depth0), d1 = hn::Sub(key(depth1), d0), d2 = hn::Sub(key(depth2), d0);
        const auto column = hn::Mul(hn::Sub(hn::Mul(d1, wide(y2)), hn::Mul(d2, wide(y1))), inverse);
        const auto row = hn::Mul(hn::Sub(hn::Mul(d2, wide(x1)), hn::Mul(d1, wide(x2))), inverse);
        const auto unit = hn::Set(d, -1.0 / fixed_one);
        const auto at = hn::Add(d0, hn::Add(hn::Mul(column, hn::Mul(wide(x0), unit)),
                                            hn::Mul(row, hn::Mul(wide(y0), unit))));
        hn::Store(hn::DemoteTo(f, at), f, t.depth + part);
        hn::Store(hn::DemoteTo(f, column), f, t.depth_column + part);
        hn::Store(hn::DemoteTo(f, row), f, t.depth_row + part);
    }

    // edge_of() of many, in the order that makes them positive within.
    HWY_INLINE void edges(const VI* x, const VI* y, Lines along, Triangles& t) const {
        const Ints i;
        const VI zero = hn::Zero(i);
        const VI px[3] = {x[0], hn::IfThenElse(along, x[1], x[2]),
                          hn::IfThenElse(along, x[2], x[1])};
        const VI py[3] = {y[0], hn::IfThenElse(along, y[1], y[2]),
                          hn::IfThenElse(along, y[2], y[1])};
        for (int k = 0; k < 3; ++k) {
            const VI dx = hn::Sub(px[(k + 1) % 3], px[k]), dy = hn::Sub(py[(k + 1) % 3], py[k]);
            const Lines own = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
            const VI at = hn::Sub(hn::Mul(dy, px[k]), hn::Mul(dx, py[k]));
            hn::Store(hn::Sub(at, hn::IfThenElse(own, zero, hn::Set(i, 1))), i, t.at[k]);
            hn::Store(hn::Neg(hn::ShiftLeft<fixed_bits>(dy)), i, t.per_column[k]);
            hn::Store(hn::ShiftLeft<fixed_bits>(dx), i, t.per_row[k]);
        }
    }

    HWY_INLINE void sides(VI s, Lines along, std::size_t view, Triangles& t,
                          HitLayers& layers) const {
        const Ints i;
        const VI grid = hn::ShiftLeft<2>(s), one = hn::Set(i, 1);
        auto field = [&](int k) {
            return hn::GatherIndex(i, grids_, hn::Add(grid, hn::Set(i, k)));
        };
        const VI front = field(0), back = field(1), cells = hn::Mul(field(2), field(3));
        const VI number = hn::Add(hn::Set(i, static_cast<std::int32_t>(view)), hn::Iota(i, 0));
        hn::Store(hn::Or(hn::ShiftLeft<1>(number), hn::IfThenElseZero(hn::Ne(cells, one), one)), i,
                  t.id);
        // As HitLayers::set_view() has them.
        const hn::RebindToUnsigned<Ints> u;
        const hn::Half<decltype(u)> half;
        const hn::RepartitionToWide<decltype(u)> wide;
        const auto toward = hn::BitCast(u, hn::IfThenElse(along, back, front));
        const auto away = hn::BitCast(u, hn::IfThenElse(along, front, back));
        auto both = [&](auto to, auto from) {
            return hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(wide, from)), hn::PromoteTo(wide, to));
        };
        std::uint64_t* place = layers.sides() + view;
        hn::StoreU(both(hn::LowerHalf(half, toward), hn::LowerHalf(half, away)), wide, place);
        hn::StoreU(both(hn::UpperHalf(half, toward), hn::UpperHalf(half, away)), wide,
                   place + hn::Lanes(wide));
    }

    const MeshTile& tile_;
    float steep_;
    const std::int32_t *surfaces_, *corners_, *grids_;
};

#endif

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
