#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/fill_layers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <utility>

#include "lines/edge_walk.h"
#include "lines/fill_surface.h"
#include "lines/hit_layers.h"
#include "lines/hits-inl.h"

#ifndef PARALLUX_LINES_FILL_LAYERS_ONCE
#define PARALLUX_LINES_FILL_LAYERS_ONCE
namespace parallux {

/// An edge of a small surface, seen from a line nearby: E(p) = (x1 - x0)(p_y - y0) - (y1 - y0)(p_x
/// - x0) in fixed point, which is positive within; less 1 where points of the edge itself belong to
/// the neighbour: a surface owns its edges on the left and above (fill_surface()'s half-open rows
/// and columns).
struct Edge {
    std::int32_t at, per_column, per_row;
};
inline Edge edge_of(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    const std::int32_t dx = x1 - x0, dy = y1 - y0;
    const bool own = dy < 0 || (dy == 0 && dx > 0);
    return {dy * x0 - dx * y0 - (own ? 0 : 1), -dy * static_cast<std::int32_t>(fixed_one),
            dx * static_cast<std::int32_t>(fixed_one)};
}

/// Blocks of 16 lines, for surfaces up to 4 and up to 8 lines wide.
struct BlockShape {
    std::int32_t width, height;
    std::uint32_t columns;  ///< lines of the first column
    alignas(64) std::int32_t x[16], y[16];
    alignas(64) std::int32_t line[16];  ///< from the block's first, in layers
};
constexpr BlockShape block_shape(std::int32_t width) {
    BlockShape shape{width, 16 / width, 0, {}, {}, {}};
    for (std::int32_t k = 0; k < 16; ++k) {
        shape.x[k] = k % width;
        shape.y[k] = k / width;
        shape.line[k] = shape.y[k] * HitLayers::side + shape.x[k];
        if (k % width == 0)
            shape.columns |= 1u << k;
    }
    return shape;
}
inline constexpr BlockShape square_block = block_shape(4), wide_block = block_shape(8);

/// By the blocks that they take: one or two square ones, one to four wide ones.
inline constexpr int block_classes = 6;

/// Surfaces no larger than this in either direction, in lines, fit the integers of a block.
inline constexpr std::int32_t small_extent = 7;

}  // namespace parallux
#endif

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Ints = hn::CappedTag<std::int32_t, 16>;
using Floats = hn::RebindToFloat<Ints>;
using VI = hn::Vec<Ints>;
using Lines = hn::Mask<Ints>;

HWY_INLINE std::uint32_t bits_of(Lines lines) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Ints(), lines, bytes);
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}

// The lines of a box that a small surface has.
struct SmallBox {
    std::int32_t line, width, height;  // the first, in layers
};

// The hits of a small surface on the lines of its box.
template <int corners>
HWY_INLINE void fill_small(const Edge* edges, const DepthPlane& plane, const SmallBox& box,
                           std::uint32_t id, bool steep, HitLayers& layers) {
    const Ints i;
    const Floats d;
    constexpr std::size_t lanes = hn::MaxLanes(Ints()), parts = 16 / lanes;
    const BlockShape& shape = box.width <= square_block.width ? square_block : wide_block;
    const std::uint32_t columns = shape.columns * ((1u << box.width) - 1);
    alignas(64) std::int32_t depth[16];
    for (std::int32_t top = 0; top < box.height; top += shape.height) {
        std::uint32_t bits = 0;
        for (std::size_t part = 0; part < parts; ++part) {
            const VI x = hn::Load(i, shape.x + part * lanes);
            const VI y = hn::Add(hn::Load(i, shape.y + part * lanes), hn::Set(i, top));
            VI out = hn::Zero(i);
            for (int k = 0; k < corners; ++k)
                out = hn::Or(out, hn::Add(hn::Set(i, edges[k].at),
                                          hn::Add(hn::Mul(x, hn::Set(i, edges[k].per_column)),
                                                  hn::Mul(y, hn::Set(i, edges[k].per_row)))));
            bits |= bits_of(hn::Gt(out, hn::Set(i, -1))) << (part * lanes);
            const auto along = hn::Mul(hn::ConvertTo(d, x), hn::Set(d, plane.per_column));
            const auto down = hn::Mul(hn::ConvertTo(d, y), hn::Set(d, plane.per_row));
            hn::Store(hn::ConvertTo(i, hn::Add(hn::Set(d, plane.at), hn::Add(along, down))), i,
                      depth + part * lanes);
        }
        // Lines beyond the tile.
        if (box.height - top < shape.height)
            bits &= (1u << (shape.width * (box.height - top))) - 1;
        const std::int32_t first = box.line + top * HitLayers::side;
        for (bits &= columns; bits != 0; bits &= bits - 1) {
            const int k = std::countr_zero(bits);
            layers.add(first + shape.line[k], HitKey(std::uint32_t(depth[k])) << 32 | id);
            if (steep)
                layers.unsure()[first + shape.line[k]] = 1;
        }
    }
}

// The hits of a surface on neighbouring lines of a row. Most often they have met equally many
// surfaces so far, and their keys go to one layer as they are.
void fill_run(const DepthPlane& plane, std::int32_t x, std::int32_t y, std::int32_t line,
              std::int32_t count, std::uint32_t id, bool steep, HitLayers& layers) {
    const Ints i;
    const Floats d;
    const hn::Rebind<std::uint8_t, Ints> d8;
    const std::int32_t lanes = static_cast<std::int32_t>(hn::Lanes(i));
    const float down = plane.at + plane.per_row * static_cast<float>(y);
    if (steep)
        std::memset(layers.unsure() + line, 1, static_cast<std::size_t>(count));
    alignas(64) std::int32_t depth[16];
    for (std::int32_t k = 0; k < count; k += lanes) {
        const auto column = hn::ConvertTo(d, hn::Add(hn::Iota(i, 0), hn::Set(i, x + k)));
        const VI depths = hn::ConvertTo(
            i, hn::Add(hn::Set(d, down), hn::Mul(hn::Set(d, plane.per_column), column)));
        const std::int32_t left = std::min(count - k, lanes), first = line + k;
        std::uint8_t* own = layers.counts() + first;
        const auto counts = hn::LoadU(d8, own);
        const std::uint32_t layer = *own;
        if (left == lanes && layer < HitLayers::layers &&
            hn::AllTrue(d8, hn::Eq(counts, hn::Set(d8, static_cast<std::uint8_t>(layer))))) {
#if HWY_TARGET != HWY_SCALAR
            const hn::RepartitionToWide<hn::RebindToUnsigned<Ints>> d64;
            const auto below = hn::Set(d64, id);
            const auto bits = hn::BitCast(hn::RebindToUnsigned<Ints>(), depths);
            const hn::Half<hn::RebindToUnsigned<Ints>> half;
            std::uint64_t* keys = layers.keys(layer) + first;
            hn::StoreU(
                hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(d64, hn::LowerHalf(half, bits))), below),
                d64, keys);
            hn::StoreU(
                hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(d64, hn::UpperHalf(half, bits))), below),
                d64, keys + lanes / 2);
            hn::StoreU(hn::Add(counts, hn::Set(d8, 1)), d8, own);
            continue;
#endif
        }
        hn::Store(depths, i, depth);
        for (std::int32_t n = 0; n < left; ++n)
            layers.add(first + n, HitKey(std::uint32_t(depth[n])) << 32 | id);
    }
}

struct Filler {
    const MeshTile& tile;
    HitLayers& layers;
    double steep;  // slopes in keys' units a line, beyond which snapping moves depths too far

    // Any surface but a small triangle.
    void fill(std::size_t view) {
        const Surface& surface = tile.scene.surfaces[tile.surfaces[view]];
        const Projection::Corner* p[4];
        for (int k = 0; k < 4; ++k)
            p[k] = &tile.projection.corners[surface.corner[k]];
        if (surface.corner[3] == none)
            p[3] = p[2];
        const Rectangle box = rectangle_of(tile.projection, surface);
        if (box.right - box.left <= small_extent && box.bottom - box.top <= small_extent &&
            turn_of(tile.projection, surface) != 0 && fits(p))
            fill_little(view, p, surface.corner[3] == none ? 3 : 4, box);
        else
            fill_large(view, surface, p);
    }

private:
    static double key_depth(float depth) {
        return (static_cast<double>(depth) + key_depth_zero) * key_depth_one;
    }

    std::uint32_t id_of(std::size_t view, const SurfaceGrid& grid) const {
        return static_cast<std::uint32_t>(view) << 1 | (grid.nu * grid.nv > 1 ? 1u : 0u);
    }

    void set_view(std::size_t view, const SurfaceGrid& grid, bool turned, const DepthPlane& plane) {
        // The front's normal points along the direction when the corners turn from x to y.
        constexpr float unit = static_cast<float>(1 / (key_depth_one * fixed_one));
        layers.set_view(view, turned ? grid.back : grid.front, turned ? grid.front : grid.back,
                        (std::fabs(plane.per_column) + std::fabs(plane.per_row)) * unit);
    }

    // The plane through the corners p0, p1 and p_last, from one line; `turned` is twice its area in
    // fixed point.
    DepthPlane plane_of(const Projection::Corner* const* p, std::int64_t turned,
                        std::int32_t column, std::int32_t row, bool& is_steep) const {
        const double inverse = static_cast<double>(fixed_one) / static_cast<double>(turned);
        const double d0 = key_depth(p[0]->depth);
        const double d1 = key_depth(p[1]->depth) - d0, d3 = key_depth(p[3]->depth) - d0;
        const double x1 = double(p[1]->x) - p[0]->x, y1 = double(p[1]->y) - p[0]->y;
        const double x3 = double(p[3]->x) - p[0]->x, y3 = double(p[3]->y) - p[0]->y;
        const double per_column = (d1 * y3 - d3 * y1) * inverse;
        const double per_row = (d3 * x1 - d1 * x3) * inverse;
        const double x = column - p[0]->x * (1.0 / fixed_one),
                     y = row - p[0]->y * (1.0 / fixed_one);
        is_steep = !(std::fabs(per_column) + std::fabs(per_row) <= steep);
        return {static_cast<float>(d0 + (per_column * x + per_row * y)),
                static_cast<float>(per_column), static_cast<float>(per_row)};
    }

    static std::int64_t turned_of(const Projection::Corner* const* p) {
        return (std::int64_t(p[1]->x) - p[0]->x) * (std::int64_t(p[3]->y) - p[0]->y) -
               (std::int64_t(p[1]->y) - p[0]->y) * (std::int64_t(p[3]->x) - p[0]->x);
    }

    static bool fits(const Projection::Corner* const* p) {
        constexpr std::int32_t most = small_extent * fixed_one;
        auto [left, right] = std::minmax({p[0]->x, p[1]->x, p[2]->x, p[3]->x});
        auto [top, bottom] = std::minmax({p[0]->y, p[1]->y, p[2]->y, p[3]->y});
        return right - left <= most && bottom - top <= most;
    }

    // A small surface whose corners all turn one way.
    void fill_little(std::size_t view, const Projection::Corner* const* p, int corners,
                     Rectangle box) {
        box = {std::max(box.left, tile.bounds.left), std::min(box.right, tile.bounds.right),
               std::max(box.top, tile.bounds.top), std::min(box.bottom, tile.bounds.bottom)};
        if (box.empty())
            return;
        const std::int64_t turned = turned_of(p);
        const SurfaceGrid& grid = tile.patches.grids[tile.surfaces[view]];
        bool is_steep = false;
        const DepthPlane plane = plane_of(p, turned, box.left, box.top, is_steep);
        set_view(view, grid, turned > 0, plane);
        const std::int32_t x = box.left * static_cast<std::int32_t>(fixed_one);
        const std::int32_t y = box.top * static_cast<std::int32_t>(fixed_one);
        Edge edges[4];
        for (int k = 0; k < corners; ++k) {
            // In the order that makes them positive within.
            const Projection::Corner* a = p[turned > 0 ? k : corners - 1 - k];
            const Projection::Corner* b =
                p[turned > 0 ? (k + 1) % corners : (2 * corners - 2 - k) % corners];
            edges[k] = edge_of(a->x - x, a->y - y, b->x - x, b->y - y);
        }
        const SmallBox small{
            (box.top - tile.bounds.top) * HitLayers::side + (box.left - tile.bounds.left),
            box.right - box.left, box.bottom - box.top};
        if (corners == 3)
            fill_small<3>(edges, plane, small, id_of(view, grid), is_steep, layers);
        else
            fill_small<4>(edges, plane, small, id_of(view, grid), is_steep, layers);
    }

    void fill_large(std::size_t view, const Surface& surface, const Projection::Corner* const* p) {
        const SurfaceGrid& grid = tile.patches.grids[tile.surfaces[view]];
        const std::int64_t turned = turned_of(p);
        bool is_steep = true;  // a parallelogram that snapping has folded to a line
        DepthPlane plane{static_cast<float>(key_depth(p[0]->depth)), 0, 0};
        if (turned != 0)
            plane = plane_of(p, turned, tile.bounds.left, tile.bounds.top, is_steep);
        set_view(view, grid, turned > 0, plane);
        fill_convex(tile.projection, surface, tile.bounds,
                    [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
                        const std::int32_t x = begin - tile.bounds.left, y = row - tile.bounds.top;
                        fill_run(plane, x, y, y * HitLayers::side + x, end - begin,
                                 id_of(view, grid), is_steep, layers);
                    });
    }
};

// Snapping moves a depth by 1 / fixed_one of both slopes at most: two surfaces that each stay below
// this slope, in keys' units a line, move by less than the tie.
double steep_slope(const MeshTile& tile) {
    return 0.45 * static_cast<double>(tile.tie) * key_depth_one * fixed_one;
}

// Asks for some surfaces of a tile, and for the corners of others, before they are needed.
HWY_INLINE void fetch(const MeshTile& tile, std::size_t surfaces, std::size_t corners,
                      std::size_t count) {
    for (std::size_t k = surfaces; k < std::min(surfaces + count, tile.count); ++k) {
        __builtin_prefetch(&tile.scene.surfaces[tile.surfaces[k]]);
        __builtin_prefetch(&tile.patches.grids[tile.surfaces[k]]);
    }
    for (std::size_t k = corners; k < std::min(corners + count, tile.count); ++k)
        for (int c = 0; c < 3; ++c)
            __builtin_prefetch(
                &tile.projection.corners[tile.scene.surfaces[tile.surfaces[k]].corner[c]]);
}

#if HWY_TARGET == HWY_SCALAR

void fill_all(const MeshTile& tile, HitLayers& layers) {
    Filler filler{tile, layers, steep_slope(tile)};
    for (std::size_t view = 0; view < tile.count; ++view)
        filler.fill(view);
}

#else

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

// The hits of small triangles of one class: `blocks` blocks of 16 lines each, one below the other.
// Every triangle of a class takes the same steps, and its hits go to a buffer, so that no branch
// depends on what it covers.
template <int width, int blocks>
HWY_INLINE void fill_class(const Triangles& t, std::uint32_t which, HitLayers& layers) {
    const Ints i;
    const Floats d;
    constexpr std::size_t lanes = hn::MaxLanes(Ints()), parts = 16 / lanes;
    constexpr const BlockShape& shape = width == 4 ? square_block : wide_block;
    constexpr std::int32_t down = shape.height;
    for (; which != 0; which &= which - 1) {
        const int k = std::countr_zero(which);
        const std::int32_t right = t.width[k], bottom = t.height[k];
        HitBuffer& buffer = layers.buffer();
        for (std::int32_t block = 0; block < blocks; ++block)
            for (std::size_t part = 0; part < parts; ++part) {
                const VI x = hn::Load(i, shape.x + part * lanes);
                const VI y = hn::Add(hn::Load(i, shape.y + part * lanes), hn::Set(i, block * down));
                VI out =
                    hn::Or(hn::Sub(hn::Set(i, right - 1), x), hn::Sub(hn::Set(i, bottom - 1), y));
                for (int e = 0; e < 3; ++e)
                    out = hn::Or(out, hn::Add(hn::Set(i, t.at[e][k]),
                                              hn::Add(hn::Mul(x, hn::Set(i, t.per_column[e][k])),
                                                      hn::Mul(y, hn::Set(i, t.per_row[e][k])))));
                const Lines in = hn::Gt(out, hn::Set(i, -1));
                const auto along = hn::Mul(hn::ConvertTo(d, x), hn::Set(d, t.depth_column[k]));
                const auto deep = hn::Mul(hn::ConvertTo(d, y), hn::Set(d, t.depth_row[k]));
                const VI depth =
                    hn::ConvertTo(i, hn::Add(hn::Set(d, t.depth[k]), hn::Add(along, deep)));
                const VI line = hn::Add(hn::Load(i, shape.line + part * lanes),
                                        hn::Set(i, t.line[k] + block * down * HitLayers::side));
                hn::StoreU(squeeze(line, in), i, buffer.line + buffer.count);
                hn::StoreU(squeeze(depth, in), i, buffer.depth + buffer.count);
                hn::StoreU(hn::Set(i, t.id[k]), i, buffer.id + buffer.count);
                buffer.count += hn::CountTrue(i, in);
            }
    }
}

void fill_all(const MeshTile& tile, HitLayers& layers) {
    Filler filler{tile, layers, steep_slope(tile)};
    const TriangleSetup setup(tile, steep_slope(tile));
    const std::size_t lanes = hn::Lanes(Ints());
    Triangles t;
    for (std::size_t view = 0; view < tile.count; view += lanes) {
        // Surfaces and corners of a tile lie all over a large scene: they are fetched ahead.
        fetch(tile, view + 2 * lanes, view + lanes, lanes);
        setup(view, t, layers);
        fill_class<4, 1>(t, t.shaped[0], layers);
        fill_class<4, 2>(t, t.shaped[1], layers);
        fill_class<8, 1>(t, t.shaped[2], layers);
        fill_class<8, 2>(t, t.shaped[3], layers);
        fill_class<8, 3>(t, t.shaped[4], layers);
        fill_class<8, 4>(t, t.shaped[5], layers);
        for (std::uint32_t left = t.other; left != 0; left &= left - 1)
            filler.fill(view + static_cast<std::size_t>(std::countr_zero(left)));
        layers.flush(HitBuffer::size - 16 * 64);
    }
    layers.flush(0);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace parallux {

HWY_EXPORT(fill_all);

void fill_layers(const MeshTile& tile, HitLayers& layers) {
    layers.reset(tile.count);
    HWY_DYNAMIC_DISPATCH(fill_all)(tile, layers);
}

void HitLayers::append_keys(std::int32_t line, std::vector<HitKey>& keys) {
    const std::uint32_t stored = std::min<std::uint32_t>(count_[line], layers);
    for (std::uint32_t layer = 0; layer < stored; ++layer)
        keys.push_back(keys_[layer * lines + line]);
    if (count_[line] <= layers)
        return;
    if (!std::exchange(beyond_sorted_, true))
        std::sort(beyond_.begin(), beyond_.end());
    const Beyond own{static_cast<std::uint32_t>(line), 0};
    auto [begin, end] = std::equal_range(beyond_.begin(), beyond_.end(), own);
    for (; begin != end; ++begin)
        keys.push_back(begin->key);
}

}  // namespace parallux
#endif
