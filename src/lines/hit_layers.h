#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

#include "lines/depth_order.h"
#include "lines/surface_view.h"
#include "lines/tile_bounds.h"
#include "parallux/aligned.h"
#include "parallux/lines.h"

namespace parallux {

// A hit as one number that sorts as hits do: its depth above, the surface's place in the tile's
// list below, and in the lowest bit whether the surface has more than one patch.
using HitKey = std::uint64_t;

/// Depths in keys: fixed point, so that differences are as exact anywhere in the scene.
inline constexpr double key_depth_one = 0x1p29;  ///< of a radius
inline constexpr double key_depth_zero = 1.25;   ///< added to a depth, so that none is negative

/// The depth of a surface at a line, in keys' units, from a column and row nearby.
struct DepthPlane {
    float at = 0, per_column = 0, per_row = 0;
};

/// Hits on their way to the layers.
struct HitBuffer {
    static constexpr std::size_t size = 2048;
    std::int32_t line[size + 16], depth[size + 16], id[size + 16];
    std::size_t count = 0;
};

/// The hits of a tile's lines in layers: the n-th surface found on a line lies in layer n, in the
/// order of the surfaces, until pair_layers() sorts them. No memory is taken for a line.
class HitLayers {
public:
    static constexpr std::int32_t side = 64;  ///< lines of a row; line = row · side + column
    static constexpr std::int32_t lines = side * side;
    static constexpr std::uint32_t layers = 16;

    HitLayers() : keys_(layers * lines), count_(lines + 64), unsure_(lines + 64) {}

    /// No hits; `views`: surfaces that may be met.
    void reset(std::size_t views) {
        std::memset(count_.data(), 0, count_.size());
        std::memset(unsure_.data(), 0, unsure_.size());
        beyond_.clear();
        beyond_sorted_ = false;
        sides_.resize(views + 16);
        moved_.resize(views + 16);
        buffer_.count = 0;
    }

    HitBuffer& buffer() { return buffer_; }
    /// Puts the buffered hits into layers when they are more than `most`.
    void flush(std::size_t most) {
        if (buffer_.count <= most)
            return;
        for (std::size_t k = 0; k < buffer_.count; ++k)
            add(buffer_.line[k], HitKey(static_cast<std::uint32_t>(buffer_.depth[k])) << 32 |
                                     static_cast<std::uint32_t>(buffer_.id[k]));
        buffer_.count = 0;
    }

    void add(std::int32_t line, HitKey key) {
        std::uint32_t n = count_[line];
        if (n < layers)
            keys_[n * lines + line] = key;
        else
            beyond_.push_back({static_cast<std::uint32_t>(line), key});
        count_[line] = static_cast<std::uint8_t>(std::min(n + 1, 255u));
    }

    /// The first patches of a view's sides, as the line that comes along and the one that looks
    /// back see them; how far snapping may have moved its depths, in radii.
    void set_view(std::size_t view, std::uint32_t toward, std::uint32_t away, float moved) {
        sides_[view] = std::uint64_t(away) << 32 | toward;
        moved_[view] = moved;
    }

    std::uint64_t* keys(std::uint32_t layer) { return &keys_[layer * lines]; }
    std::uint8_t* counts() { return count_.data(); }
    std::uint8_t* unsure() { return unsure_.data(); }  ///< ≠ 0: depths do not tell the order
    /// As set_view() has them; both have room for a vector beyond the last view.
    std::uint64_t* sides() { return sides_.data(); }
    const std::uint64_t* sides() const { return sides_.data(); }
    float* moved() { return moved_.data(); }
    float moved(std::size_t view) const { return moved_[view]; }

    /// Hits of all lines; of lines with more than 255, those.
    std::size_t hits() const {
        return std::accumulate(count_.begin(), count_.end(), std::size_t(0));
    }
    /// Appends all keys of one line, in no order.
    void append_keys(std::int32_t line, std::vector<HitKey>& keys);

private:
    struct Beyond {
        std::uint32_t line;
        HitKey key;
        bool operator<(const Beyond& other) const { return line < other.line; }
    };
    template <class T>
    using Array = std::vector<T, CacheAligned<T>>;
    Array<std::uint64_t> keys_;
    Array<std::uint8_t> count_, unsure_;
    std::vector<std::uint64_t> sides_;
    std::vector<float> moved_;
    HitBuffer buffer_;
    bool beyond_sorted_ = false;
    std::vector<Beyond> beyond_;  // hits of lines that meet more surfaces than there are layers
};

/// What a tile of a mesh is made from.
struct MeshTile {
    const Projection& projection;
    const Scene& scene;
    const Patches& patches;
    TileBounds bounds;
    const std::uint32_t* surfaces;  ///< those that may meet the tile, in order
    std::size_t count;
    float tie;  ///< depths no further apart do not tell the order; in radii
};

/// The tie in keys' units.
inline std::int32_t key_tie(const MeshTile& tile) {
    return static_cast<std::int32_t>(static_cast<double>(tile.tie) * key_depth_one) + 1;
}

/// The views of those surfaces of a tile that are asked for; the others are never made.
class ViewCache {
public:
    void reset(std::size_t count) {
        place_.assign(count, none);
        views_.clear();
    }
    const SurfaceView& of(const MeshTile& tile, std::size_t k) {
        if (place_[k] == none) {
            place_[k] = static_cast<std::uint32_t>(views_.size());
            views_.push_back(view_of(tile.projection, tile.scene, tile.patches, tile.surfaces[k]));
        }
        return views_[place_[k]];
    }

private:
    std::vector<std::uint32_t> place_;
    std::vector<SurfaceView> views_;
};

/// Orders the keys of a line again where depths do not tell; see TieOrder.
class KeyTies {
public:
    KeyTies(const MeshTile& tile, const HitLayers& layers, const glm::dvec3& centre,
            std::vector<float>& slack, SurfaceRelations& relations)
        : tile_(tile), layers_(layers), centre_(centre), slack_(slack), relations_(relations) {}

    /// keys[0], keys[stride] … of a line of the tile, sorted; none of a steep surface.
    void order(HitKey* keys, std::size_t stride, std::uint32_t count, std::int32_t line) const;
    /// What a key says of its hit; of a surface of many patches, the first.
    Hit hit(HitKey key) const;

private:
    const MeshTile& tile_;
    const HitLayers& layers_;
    const glm::dvec3& centre_;
    std::vector<float>& slack_;
    SurfaceRelations& relations_;
};

/// Finds all hits of the tile's lines: small triangles by testing blocks of lines against their
/// edges in integers, others row by row. The coverage is that of fill_surface().
void fill_layers(const MeshTile& tile, HitLayers& layers);

/// Sorts the hits of every line and appends its pairs. Lines that meet a steep surface or have more
/// hits than layers are handed back instead.
void pair_layers(const MeshTile& tile, HitLayers& layers, ViewCache& views, const KeyTies& ties,
                 TilePairs& pairs, std::vector<std::int32_t>& left);

}  // namespace parallux
