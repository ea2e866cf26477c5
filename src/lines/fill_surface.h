#pragma once

#include <algorithm>

#include "lines/ball.h"
#include "lines/edge_walk.h"
#include "lines/rectangle.h"
#include "lines/tile_bounds.h"
#include "parallux/lines.h"

namespace parallux {

/// The most rows of lines that a tile has.
inline constexpr std::int32_t most_tile_rows = 64;

/// The runs of a surface's lines in a tile, row by row: in each row the edges' columns, sorted,
/// bound the runs in pairs. That is right for any polygon, even one that snapping has folded.
/// emit(row, first column, end column), in the bundle's rows and columns.
template <class Emit>
void fill_surface(const Projection& projection, const Surface& surface, const TileBounds& tile,
                  Emit&& emit) {
    if (surface.is_curved())
        return fill_ball(projection.balls[surface.curve], tile, emit);
    unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    Rectangle r = rectangle_of(projection, surface);
    std::int32_t first = std::max(tile.top, r.top), end = std::min(tile.bottom, r.bottom);
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
            std::int32_t begin = std::max(column[k], tile.left);
            std::int32_t stop = std::min(column[k + 1], tile.right);
            if (begin < stop)
                emit(row, begin, stop);
        }
    }
}

/// 1 or -1: the snapped corners of a surface turn one way all round, as x turns to y or against it.
/// 0: they do not, or are not worth the while.
inline int turn_of(const Projection& projection, const Surface& surface) {
    unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    const Projection::Corner* p[4];
    for (unsigned k = 0; k < corners; ++k)
        p[k] = &projection.corners[surface.corner[k]];
    bool left = false, right = false;
    for (unsigned k = 0; k < corners; ++k) {
        const Projection::Corner &a = *p[k], &b = *p[(k + 1) % corners], &c = *p[(k + 2) % corners];
        std::int64_t cross = (std::int64_t(b.x) - a.x) * (std::int64_t(c.y) - b.y) -
                             (std::int64_t(b.y) - a.y) * (std::int64_t(c.x) - b.x);
        left = left || cross <= 0;
        right = right || cross >= 0;
    }
    return left == right ? 0 : right ? 1 : -1;
}

/// The same runs as fill_surface(). Where corners turn one way, edges that run down bound the lines
/// on one side and edges that run up on the other, so that no row has to be sorted.
template <class Emit>
void fill_convex(const Projection& projection, const Surface& surface, const TileBounds& tile,
                 Emit&& emit) {
    const int turn = surface.is_curved() ? 0 : turn_of(projection, surface);
    if (turn == 0)
        return fill_surface(projection, surface, tile, emit);
    unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    std::int32_t column[2][most_tile_rows];  // where the lines of each row begin and end
    std::int32_t first = tile.bottom, end = tile.top;
    for (unsigned k = 0; k < corners; ++k) {
        const Projection::Corner& a = projection.corners[surface.corner[k]];
        const Projection::Corner& b =
            projection.corners[surface.corner[k + 1 == corners ? 0 : k + 1]];
        EdgeWalk edge(a.x, a.y, b.x, b.y, tile.top);
        std::int32_t* side = column[(b.y > a.y) == (turn > 0)];
        const std::int32_t stop = std::min(edge.end_row(), tile.bottom);
        if (edge.first_row() >= stop)
            continue;
        first = std::min(first, edge.first_row());
        end = std::max(end, stop);
        for (std::int32_t row = edge.first_row(); row < stop; ++row, edge.next_row())
            side[row - tile.top] = edge.column();
    }
    for (std::int32_t row = first; row < end; ++row) {
        std::int32_t begin = std::max(column[0][row - tile.top], tile.left);
        std::int32_t stop = std::min(column[1][row - tile.top], tile.right);
        if (begin < stop)
            emit(row, begin, stop);
    }
}

}  // namespace parallux
