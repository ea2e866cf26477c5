// The hits of one surface of a mesh, for the vector code of each instruction set.

#if defined(PARALLUX_LINES_FILL_ONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_LINES_FILL_ONE_INL_H_
#undef PARALLUX_LINES_FILL_ONE_INL_H_
#else
#define PARALLUX_LINES_FILL_ONE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "lines/fill_surface.h"
#include "lines/hit_layers.h"
#include "lines/hits-inl.h"
#include "lines/line_lanes-inl.h"
#include "lines/small_surface.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

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
// depths_at(k): the depths of the k-th line and those after it.
template <class Depths>
HWY_INLINE void fill_run(std::int32_t line, std::int32_t count, std::uint32_t id, bool steep,
                         HitLayers& layers, Depths&& depths_at) {
    const Ints i;
    const hn::Rebind<std::uint8_t, Ints> d8;
    const std::int32_t lanes = static_cast<std::int32_t>(hn::Lanes(i));
    if (steep)
        std::memset(layers.unsure() + line, 1, static_cast<std::size_t>(count));
    alignas(64) std::int32_t depth[16];
    for (std::int32_t k = 0; k < count; k += lanes) {
        const VI depths = depths_at(k);
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
        if (surface.is_curved())
            return fill_half(view);
        const Projection::Corner* p[4];
        for (int k = 0; k < 3; ++k)
            p[k] = &tile.projection.corners[surface.corner[k]];
        p[3] =
            &tile.projection.corners[surface.corner_v()];  // a triangle has its last corner twice
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
                        const Ints i;
                        const Floats d;
                        const std::int32_t x = begin - tile.bounds.left, y = row - tile.bounds.top;
                        const float down = plane.at + plane.per_row * static_cast<float>(y);
                        fill_run(y * HitLayers::side + x, end - begin, id_of(view, grid), is_steep,
                                 layers, [&](std::int32_t k) {
                                     const auto column = hn::ConvertTo(
                                         d, hn::Add(hn::Iota(i, 0), hn::Set(i, x + k)));
                                     return hn::ConvertTo(
                                         i, hn::Add(hn::Set(d, down),
                                                    hn::Mul(hn::Set(d, plane.per_column), column)));
                                 });
                    });
    }

    // Half of a sphere.
    void fill_half(std::size_t view) {
        const Ints i;
        const Floats d;
        const SurfaceGrid& grid = tile.patches.grids[tile.surfaces[view]];
        const SurfaceView own =
            view_of(tile.projection, tile.scene, tile.patches, tile.surfaces[view]);
        layers.set_view(view, own.toward, own.away, own.moved);
        const Projection::Ball& ball = *own.ball;
        const auto middle =
            hn::Set(d, static_cast<float>((ball.depth + key_depth_zero) * key_depth_one));
        const auto per_spacing =
            hn::Set(d, static_cast<float>((own.far ? 1 : -1) * ball.per_spacing * key_depth_one));
        fill_ball(ball, tile.bounds, [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
            const BallRow lines = row_of(ball, row);
            const std::int32_t line =
                (row - tile.bounds.top) * HitLayers::side + (begin - tile.bounds.left);
            fill_run(line, end - begin, id_of(view, grid), false, layers, [&](std::int32_t k) {
                const auto x = hn::ConvertTo(d, hn::Add(hn::Iota(i, 0), hn::Set(i, k)));
                VF aside;
                const VF half = ball_half(d, lines, x, begin, aside);
                return hn::ConvertTo(i, hn::Add(middle, hn::Mul(per_spacing, half)));
            });
        });
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
