#include <algorithm>

#include "lines/depth_order.h"
#include "lines/fill_surface.h"
#include "lines/painter.h"
#include "lines/sort_hits.h"
#include "lines/tile_bounds.h"
#include "lines/workspace.h"

namespace parallux {

void TilePairs::clear() {
    for (PatchList* list : {&from, &to, &first, &last, &into_backs, &from_backs})
        list->count = 0;
    lines = nonempty = hits = odd = 0;
}

void TilePairs::reserve(std::size_t more_hits) {
    // Whole vectors are stored at the end of a list.
    constexpr std::size_t room = 16;
    for (PatchList* list : {&from, &to, &first, &last, &into_backs, &from_backs})
        if (list->ids.size() < list->count + more_hits + room)
            list->ids.resize(2 * (list->count + more_hits + room));
}

TilePairs::Mark TilePairs::mark() const {
    return {from.count,       first.count, last.count, into_backs.count,
            from_backs.count, nonempty,    hits,       odd};
}

void TilePairs::back_to(const Mark& mark) {
    from.count = to.count = mark.from;
    first.count = mark.first;
    last.count = mark.last;
    into_backs.count = mark.into_backs;
    from_backs.count = mark.from_backs;
    nonempty = mark.nonempty;
    hits = mark.hits;
    odd = mark.odd;
}

void append_pairs(const IntersectionLists& lists, TilePairs& pairs) {
    auto add = [](PatchList& list, std::uint32_t patch) { list.ids[list.count++] = patch; };
    pairs.lines += lists.lines();
    pairs.hits += lists.hits.size();
    pairs.reserve(lists.hits.size());
    for (std::size_t line = 0; line < lists.lines(); ++line) {
        std::uint32_t begin = lists.start[line], end = lists.start[line + 1];
        if (begin == end)
            continue;
        ++pairs.nonempty;
        pairs.odd += (end - begin) % 2;
        if (std::uint32_t first = lists.hits[begin].toward; first != none)
            add(pairs.first, first);
        if (std::uint32_t last = lists.hits[end - 1].away; last != none)
            add(pairs.last, last);
        for (std::uint32_t k = begin; k + 1 < end; ++k) {
            std::uint32_t i = lists.hits[k].away, j = lists.hits[k + 1].toward;
            if (i != none && j != none) {
                add(pairs.from, i);
                add(pairs.to, j);
            } else if (i != none) {
                add(pairs.into_backs, i);
            } else if (j != none) {
                add(pairs.from_backs, j);
            }
        }
    }
}

namespace {

// Whether so few surfaces meet the tile that each covers many of its lines.
bool paintable(const Projection& projection, std::size_t tile) {
    return !projection.order.empty() &&
           projection.tile_start[tile + 1] - projection.tile_start[tile] <= 96;
}

// Fills the surfaces of a tile, in their order, with runs of lines, and deals the runs to their
// rows.
void fill_rows(const Projection& projection, const Scene& scene, const Patches& patches,
               std::size_t tile, const TileBounds& bounds, Projector::Workspace& work) {
    work.views.clear();
    work.spans.clear();
    work.slack.resize(scene.surfaces.size());
    work.row_start.assign(static_cast<std::size_t>(bounds.rows()) + 1, 0);
    for (std::uint32_t k = projection.tile_start[tile]; k < projection.tile_start[tile + 1]; ++k) {
        std::uint32_t s = projection.tile_surfaces[k];
        std::uint32_t view = static_cast<std::uint32_t>(work.views.size());
        std::size_t before = work.spans.size();
        fill_surface(projection, scene.surfaces[s], bounds.left, bounds.right, bounds.top,
                     bounds.bottom, [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
                         work.spans.push_back(
                             {view, row - bounds.top, begin - bounds.left, end - bounds.left});
                         ++work.row_start[static_cast<std::size_t>(row - bounds.top) + 1];
                     });
        if (work.spans.size() > before) {
            work.views.push_back(view_of(projection, scene, patches, s));
            work.slack[s] = work.views.back().moved;
        }
    }
    for (std::size_t row = 1; row < work.row_start.size(); ++row)
        work.row_start[row] += work.row_start[row - 1];
    work.cursor.assign(work.row_start.begin(), work.row_start.end() - 1);
    work.row_spans.resize(work.spans.size());
    for (const Span& span : work.spans)
        work.row_spans[work.cursor[static_cast<std::size_t>(span.row)]++] = {span.view, span.begin,
                                                                             span.end};
}

// The lists of the unsure lines of a row, as lists() would have them.
void list_unsure(const Projection& projection, const Scene& scene, const Patches& patches,
                 const glm::dvec3& centre, double radius, Projector::Workspace& work,
                 const RowSpan* spans, std::size_t count, std::int32_t left, std::int32_t row,
                 std::int32_t columns) {
    IntersectionLists& lists = work.unsure;
    lists.start.assign(1, 0);
    lists.hits.clear();
    float tie = near_tie(projection.bundle.spacing, radius);
    for (std::int32_t column = 0; column < columns; ++column) {
        if (work.state.unsure[static_cast<std::size_t>(column)] == 0)
            continue;
        std::size_t begin = lists.hits.size();
        for (std::size_t k = 0; k < count; ++k)
            if (spans[k].begin <= column && column < spans[k].end)
                lists.hits.push_back(hit_at(work.views[spans[k].view], left + column, row));
        Hit *first = lists.hits.data() + begin, *end = lists.hits.data() + lists.hits.size();
        if (sort_hits(first, end, tie, work.slack))
            order_near_ties(projection, scene, patches, centre, radius, left + column, row,
                            work.slack, first, end);
        lists.start.push_back(static_cast<std::uint32_t>(lists.hits.size()));
    }
}

}  // namespace

void Projector::pairs(const Projection& projection, std::size_t tile, Workspace& work,
                      TilePairs& pairs) const {
    pairs.clear();
    if (!paintable(projection, tile)) {
        lists(projection, tile, work, work.unsure);
        append_pairs(work.unsure, pairs);
        return;
    }
    const TileBounds bounds = tile_bounds(projection, tile);
    const std::int32_t left = bounds.left, columns = bounds.columns();
    pairs.lines = bounds.lines();
    fill_rows(projection, scene_, patches_, tile, bounds, work);

    // Paint row after row; where the order is unsure, once more without those lines.
    for (std::int32_t row = 0; row < bounds.rows(); ++row) {
        const RowSpan* spans = &work.row_spans[work.row_start[static_cast<std::size_t>(row)]];
        std::size_t count = work.row_start[static_cast<std::size_t>(row) + 1] -
                            work.row_start[static_cast<std::size_t>(row)];
        if (count == 0)
            continue;
        pairs.reserve(count * tile_side);
        TilePairs::Mark mark = pairs.mark();
        work.state.unsure.fill(0);
        work.state.clear();
        if (!paint_row(work.views.data(), spans, count, left, bounds.top + row, columns, false,
                       work.state, pairs))
            continue;
        pairs.back_to(mark);
        work.state.clear();
        paint_row(work.views.data(), spans, count, left, bounds.top + row, columns, true,
                  work.state, pairs);
        list_unsure(projection, scene_, patches_, centre_, radius_, work, spans, count, left,
                    bounds.top + row, columns);
        append_pairs(work.unsure, pairs);
        pairs.lines -= work.unsure.lines();
    }
}

}  // namespace parallux
