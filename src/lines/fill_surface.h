#pragma once

#include <algorithm>

#include "lines/edge_walk.h"
#include "lines/rectangle.h"
#include "parallux/lines.h"

namespace parallux {

/// The runs of a surface's lines in a tile, row by row: in each row the edges' columns, sorted,
/// bound the runs in pairs. That is right for any polygon, even one that snapping has folded.
template <class Emit>
void fill_surface(const Projection& projection, const Surface& surface, std::int32_t left,
                  std::int32_t right, std::int32_t top, std::int32_t bottom, Emit&& emit) {
    unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    Rectangle r = rectangle_of(projection, surface);
    std::int32_t first = std::max(top, r.top), end = std::min(bottom, r.bottom);
    if (first >= end)
        return;
    auto edge = [&](unsigned k) {
        const Projection::Corner& a = projection.corners[surface.corner[k]];
        const Projection::Corner& b =
            projection.corners[surface.corner[k + 1 == corners ? 0 : k + 1]];
        return EdgeWalk(a.x, a.y, b.x, b.y, first);
    };
    EdgeWalk edges[4] = {edge(0), edge(1), edge(2), edge(corners == 4 ? 3 : 2)};
    for (std::int32_t row = first; row < end; ++row) {
        std::int32_t column[4];
        unsigned crossings = 0;
        for (unsigned k = 0; k < corners; ++k)
            if (row >= edges[k].first_row() && row < edges[k].end_row()) {
                std::int32_t c = edges[k].column();
                edges[k].next_row();
                unsigned place = crossings++;
                for (; place > 0 && column[place - 1] > c; --place)
                    column[place] = column[place - 1];
                column[place] = c;
            }
        for (unsigned k = 0; k + 1 < crossings; k += 2) {
            std::int32_t begin = std::max(column[k], left), stop = std::min(column[k + 1], right);
            if (begin < stop)
                emit(row, begin, stop);
        }
    }
}

}  // namespace parallux
