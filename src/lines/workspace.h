#pragma once

#include <vector>

#include "lines/depth_order.h"
#include "lines/hit_layers.h"
#include "lines/painter.h"
#include "lines/surface_view.h"
#include "parallux/lines.h"

namespace parallux {

/// A run of lines in one row of a tile that meet one surface.
struct Span {
    std::uint32_t view;
    std::int32_t row, begin, end;  ///< columns, all from the tile's corner
};

struct Projector::Workspace {
    Workspace(const Scene& scene, double radius, const std::vector<bool>& sheets)
        : relations(scene, radius, sheets) {}

    SurfaceRelations relations;
    std::vector<SurfaceView> views;
    std::vector<Span> spans;
    std::vector<std::uint32_t> cursor;
    std::vector<float> slack;  ///< one a surface; only those of the present tile are up to date
    BlockLists blocks;
    HitLayers layers;
    ViewCache view_cache;
    std::vector<UnsureLines> unsure_blocks;  ///< lines whose order the painter could not tell
    std::vector<std::int32_t> left_lines;    ///< or that the layers cannot hold
    std::vector<HitKey> keys;                ///< of one of those
    IntersectionLists lists;                 ///< of those lines
};

}  // namespace parallux
