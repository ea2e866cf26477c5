#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/fill_layers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <utility>

#include "lines/fill_one-inl.h"
#include "lines/hit_layers.h"
#include "lines/hits-inl.h"
#include "lines/line_lanes-inl.h"
#include "lines/triangle_setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

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
