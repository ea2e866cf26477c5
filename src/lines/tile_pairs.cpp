#include <bit>

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
           projection.tile_start[tile + 1] - projection.tile_start[tile] <= BlockLists::most_views;
}

// Fills the surfaces of a tile, in their order, with runs of lines, and deals the runs to blocks.
void fill_blocks(const Projection& projection, const Scene& scene, const Patches& patches,
                 std::size_t tile, const TileBounds& bounds, Projector::Workspace& work) {
    const std::uint32_t begin = projection.tile_start[tile], end = projection.tile_start[tile + 1];
    work.views.clear();
    work.slack.resize(scene.surfaces.size());
    work.blocks.reset(bounds, end - begin);
    for (std::uint32_t k = begin; k < end; ++k) {
        std::uint32_t s = projection.tile_surfaces[k];
        std::uint16_t view = static_cast<std::uint16_t>(work.views.size());
        std::uint64_t before = work.blocks.hits();
        fill_convex(projection, scene.surfaces[s], bounds,
                    [&](std::int32_t row, std::int32_t first, std::int32_t stop) {
                        work.blocks.add(view, row - bounds.top, first - bounds.left,
                                        stop - bounds.left);
                    });
        if (work.blocks.hits() > before) {
            work.views.push_back(view_of(projection, scene, patches, s));
            work.slack[s] = work.views.back().moved;
        }
    }
}

}  // namespace

// The lists of the lines that the painter left, as lists() would have them.
void Projector::list_unsure(const Projection& projection, const TileBounds& bounds,
                            Workspace& work) const {
    IntersectionLists& lists = work.lists;
    lists.start.assign(1, 0);
    lists.hits.clear();
    float tie = near_tie(projection.bundle.spacing, radius_);
    const std::size_t blocks = static_cast<std::size_t>(work.blocks.blocks());
    for (const UnsureLines& unsure : work.unsure)
        for (std::uint32_t left = unsure.lines; left != 0; left &= left - 1) {
            const int line = std::countr_zero(left);
            const std::int32_t row = bounds.top + static_cast<std::int32_t>(unsure.block / blocks);
            const std::int32_t column =
                bounds.left + static_cast<std::int32_t>(unsure.block % blocks) * block_lines + line;
            std::size_t begin = lists.hits.size();
            for (const BlockSpan* span = work.blocks.begin(unsure.block);
                 span != work.blocks.end(unsure.block); ++span)
                if (span->lines >> line & 1)
                    lists.hits.push_back(hit_at(work.views[span->view], column, row));
            Hit *first = lists.hits.data() + begin, *end = lists.hits.data() + lists.hits.size();
            if (sort_hits(first, end, tie, work.slack))
                order_near_ties(projection, scene_, patches_, centre_, radius_, column, row,
                                work.slack, first, end);
            lists.start.push_back(static_cast<std::uint32_t>(lists.hits.size()));
        }
}

void Projector::pairs(const Projection& projection, std::size_t tile, Workspace& work,
                      TilePairs& pairs) const {
    pairs.clear();
    if (!paintable(projection, tile)) {
        lists(projection, tile, work, work.lists);
        append_pairs(work.lists, pairs);
        return;
    }
    const TileBounds bounds = tile_bounds(projection, tile);
    fill_blocks(projection, scene_, patches_, tile, bounds, work);
    pairs.reserve(work.blocks.hits());
    work.unsure.clear();
    paint(work.views.data(), work.blocks, bounds, pairs, work.unsure);
    if (!work.unsure.empty()) {
        list_unsure(projection, bounds, work);
        append_pairs(work.lists, pairs);
    }
    pairs.lines = bounds.lines();
    pairs.hits = work.blocks.hits();
}

}  // namespace parallux
