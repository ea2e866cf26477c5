#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/depth_order.h"
#include "lines/facets.h"
#include "lines/fill_surface.h"
#include "lines/sort_hits.h"
#include "lines/surface_view.h"
#include "lines/tile_bounds.h"
#include "lines/workspace.h"
#include "parallux/lines.h"

namespace parallux {

std::shared_ptr<Projector::Workspace> Projector::make_workspace() const {
    return std::make_shared<Workspace>(scene_, radius_, *sheets_);
}

void Projector::lists(const Projection& projection, std::size_t tile, Workspace& workspace,
                      IntersectionLists& lists) const {
    const TileBounds bounds = tile_bounds(projection, tile);
    const std::int32_t left = bounds.left, top = bounds.top;
    const std::int32_t columns = bounds.columns();
    const std::size_t lines = bounds.lines();

    // Fill the surfaces of the tile with runs, and count the hits of every line.
    workspace.views.clear();
    workspace.spans.clear();
    workspace.slack.resize(scene_.surfaces.size());
    lists.start.assign(lines + 1, 0);
    for (std::uint32_t k = projection.tile_start[tile]; k < projection.tile_start[tile + 1]; ++k) {
        std::uint32_t s = projection.tile_surfaces[k];
        std::uint32_t view = static_cast<std::uint32_t>(workspace.views.size());
        bool any = false;
        fill_surface(projection, scene_.surfaces[s], bounds,
                     [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
                         any = true;
                         workspace.spans.push_back({view, row - top, begin - left, end - left});
                         std::uint32_t* count = &lists.start[(row - top) * columns + 1];
                         for (std::int32_t column = begin - left; column < end - left; ++column)
                             ++count[column];
                     });
        if (any) {
            workspace.views.push_back(view_of(projection, scene_, patches_, s));
            workspace.slack[s] = workspace.views.back().moved;
        }
    }

    // Place every hit in its line's list.
    for (std::size_t line = 0; line < lines; ++line)
        lists.start[line + 1] += lists.start[line];
    workspace.cursor.assign(lists.start.begin(), lists.start.end() - 1);
    lists.hits.resize(lists.start.back());
    for (const Span& span : workspace.spans) {
        const SurfaceView& view = workspace.views[span.view];
        std::uint32_t* cursor = &workspace.cursor[span.row * columns];
        for (std::int32_t column = span.begin; column < span.end; ++column)
            lists.hits[cursor[column]++] = hit_at(view, left + column, top + span.row);
    }

    // Order each list; where hits all but coincide, look closer.
    float tie = near_tie(projection.bundle.spacing, radius_);
    for (std::size_t line = 0; line < lines; ++line) {
        Hit* begin = lists.hits.data() + lists.start[line];
        Hit* end = lists.hits.data() + lists.start[line + 1];
        if (sort_hits(begin, end, tie, workspace.slack))
            order_near_ties(projection, scene_, patches_, centre_,
                            left + static_cast<std::int32_t>(line) % columns,
                            top + static_cast<std::int32_t>(line) / columns, workspace.slack,
                            workspace.relations, begin, end);
    }
    if (facets_)
        for (Hit& hit : lists.hits)
            hit.surface = facets_->parent[hit.surface];
}

}  // namespace parallux
