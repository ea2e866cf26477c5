#pragma once

#include <vector>

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
    std::vector<SurfaceView> views;
    std::vector<Span> spans;
    std::vector<std::uint32_t> cursor;
    std::vector<float> slack;  ///< one a surface; only those of the present tile are up to date
    BlockLists blocks;
    std::vector<UnsureLines> unsure;  ///< lines whose order the painter could not tell
    IntersectionLists lists;
};

}  // namespace parallux
