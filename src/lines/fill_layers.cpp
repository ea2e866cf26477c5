#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/fill_layers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <utility>

#include "lines/edge_walk.h"
#include "lines/fill_surface.h"
#include "lines/hit_layers.h"

#ifndef PARALLUX_LINES_FILL_LAYERS_ONCE
#define PARALLUX_LINES_FILL_LAYERS_ONCE
namespace parallux {

/// A small triangle or parallelogram seen from a line nearby; corners in fixed point, in the order
/// that makes their edges positive within.
struct SmallSurface {
    std::int32_t x[4], y[4];
};

/// Blocks of 16 lines, for surfaces up to 4 and up to 8 lines wide.
struct BlockShape {
    std::int32_t width, height;
    std::uint32_t columns;  ///< lines of the first column
    alignas(64) std::int32_t x[16], y[16];
    std::int32_t line[16];  ///< from the block's first, in layers
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

HWY_INLINE std::uint32_t bits_of(hn::Mask<Ints> lines) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Ints(), lines, bytes);
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}

// E(p) = (x1 - x0)(p_y - y0) - (y1 - y0)(p_x - x0), which is positive within; points of an edge
// itself belong to the surface where the edge bounds it on the left, or above (fill_surface()'s
// half-open rows and columns).
struct Edge {
    std::int32_t at, per_column, per_row;

    Edge() = default;
    HWY_INLINE Edge(const SmallSurface& t, int a, int b) {
        const std::int32_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
        const bool own = dy < 0 || (dy == 0 && dx > 0);
        at = dy * t.x[a] - dx * t.y[a] - (own ? 0 : 1);
        per_column = -dy * static_cast<std::int32_t>(fixed_one);
        per_row = dx * static_cast<std::int32_t>(fixed_one);
    }
};

// The hits of a small surface on the lines of its box, which begins at `line`.
template <int corners>
HWY_INLINE void fill_small(const SmallSurface& t, const DepthPlane& plane, std::int32_t line,
                           std::int32_t width, std::int32_t height, std::uint32_t id, bool steep,
                           HitLayers& layers) {
    const Ints i;
    const Floats d;
    const std::size_t lanes = hn::Lanes(i), parts = 16 / lanes;
    const BlockShape& shape = width <= square_block.width ? square_block : wide_block;
    Edge edges[corners];
    for (int k = 0; k < corners; ++k)
        edges[k] = Edge(t, k, (k + 1) % corners);
    alignas(64) std::int32_t depth[16];
    for (std::int32_t top = 0; top < height; top += shape.height) {
        std::uint32_t bits = 0;
        for (std::size_t part = 0; part < parts; ++part) {
            const VI x = hn::Load(i, shape.x + part * lanes);
            const VI y = hn::Add(hn::Load(i, shape.y + part * lanes), hn::Set(i, top));
            VI out = hn::Zero(i);
            for (const Edge& edge : edges)
                out = hn::Or(out, hn::Add(hn::Set(i, edge.at),
                                          hn::Add(hn::Mul(x, hn::Set(i, edge.per_column)),
                                                  hn::Mul(y, hn::Set(i, edge.per_row)))));
            bits |= bits_of(hn::Gt(out, hn::Set(i, -1))) << (part * lanes);
            const auto along = hn::Mul(hn::ConvertTo(d, x), hn::Set(d, plane.per_column));
            const auto down = hn::Mul(hn::ConvertTo(d, y), hn::Set(d, plane.per_row));
            hn::Store(hn::ConvertTo(i, hn::Add(hn::Set(d, plane.at), hn::Add(along, down))), i,
                      depth + part * lanes);
        }
        // Lines beyond the tile.
        if (height - top < shape.height)
            bits &= (1u << (shape.width * (height - top))) - 1;
        bits &= shape.columns * ((1u << width) - 1);
        const std::int32_t first = line + top * HitLayers::side;
        for (; bits != 0; bits &= bits - 1) {
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

    void fill(std::size_t view) {
        const Surface& surface = tile.scene.surfaces[tile.surfaces[view]];
        const bool triangle = surface.corner[3] == none;
        const Projection::Corner* p[4];
        for (int k = 0; k < 4; ++k)
            p[k] = &tile.projection.corners[surface.corner[k == 3 && triangle ? 2 : k]];
        const std::int32_t low_x = std::min({p[0]->x, p[1]->x, p[2]->x, p[3]->x});
        const std::int32_t high_x = std::max({p[0]->x, p[1]->x, p[2]->x, p[3]->x});
        const std::int32_t low_y = std::min({p[0]->y, p[1]->y, p[2]->y, p[3]->y});
        const std::int32_t high_y = std::max({p[0]->y, p[1]->y, p[2]->y, p[3]->y});
        constexpr std::int32_t most = small_extent * fixed_one;
        if (high_x - low_x > most || high_y - low_y > most)
            return fill_large(view, surface, p);
        const Rectangle box{std::max(first_line(low_x), tile.bounds.left),
                            std::min(first_line(high_x), tile.bounds.right),
                            std::max(first_line(low_y), tile.bounds.top),
                            std::min(first_line(high_y), tile.bounds.bottom)};
        if (box.empty())
            return;
        if (triangle)
            fill_little<3>(view, p, box);
        else if (turn_of(tile.projection, surface) != 0)
            fill_little<4>(view, p, box);
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

    // A triangle, or a parallelogram whose corners all turn one way.
    template <int corners>
    HWY_INLINE void fill_little(std::size_t view, const Projection::Corner* const* p,
                                const Rectangle& box) {
        const std::int64_t turned = turned_of(p);
        if (turned == 0)
            return;
        const SurfaceGrid& grid = tile.patches.grids[tile.surfaces[view]];
        bool is_steep = false;
        const DepthPlane plane = plane_of(p, turned, box.left, box.top, is_steep);
        set_view(view, grid, turned > 0, plane);
        const std::int32_t x = box.left * static_cast<std::int32_t>(fixed_one);
        const std::int32_t y = box.top * static_cast<std::int32_t>(fixed_one);
        SmallSurface small;
        for (int k = 0; k < corners; ++k) {
            const Projection::Corner& corner = *p[turned > 0 ? k : corners - 1 - k];
            small.x[k] = corner.x - x;
            small.y[k] = corner.y - y;
        }
        const std::int32_t line =
            (box.top - tile.bounds.top) * HitLayers::side + (box.left - tile.bounds.left);
        fill_small<corners>(small, plane, line, box.right - box.left, box.bottom - box.top,
                            id_of(view, grid), is_steep, layers);
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

void fill_all(const MeshTile& tile, HitLayers& layers) {
    // Snapping moves a depth by 1 / fixed_one of both slopes at most: two surfaces that each stay
    // below this move by less than the tie.
    const double steep = 0.45 * static_cast<double>(tile.tie) * key_depth_one * fixed_one;
    Filler filler{tile, layers, steep};
    // Surfaces and corners of a tile lie all over a large scene: they are fetched ahead.
    constexpr std::size_t surface_ahead = 16, corners_ahead = 8;
    const Surface* surfaces = tile.scene.surfaces.data();
    for (std::size_t view = 0; view < tile.count; ++view) {
        if (view + surface_ahead < tile.count) {
            __builtin_prefetch(&surfaces[tile.surfaces[view + surface_ahead]]);
            __builtin_prefetch(&tile.patches.grids[tile.surfaces[view + surface_ahead]]);
        }
        if (view + corners_ahead < tile.count) {
            const Surface& next = surfaces[tile.surfaces[view + corners_ahead]];
            for (int k = 0; k < 3; ++k)
                __builtin_prefetch(&tile.projection.corners[next.corner[k]]);
        }
        filler.fill(view);
    }
}

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
