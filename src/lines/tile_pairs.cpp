#include <bit>

#include "lines/depth_order.h"
#include "lines/fill_surface.h"
#include "lines/hit_layers.h"
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

void Projector::order_list(const Projection& projection, std::int32_t column, std::int32_t row,
                           std::size_t begin, Workspace& work) const {
    Hit *first = work.lists.hits.data() + begin,
        *end = work.lists.hits.data() + work.lists.hits.size();
    if (sort_hits(first, end, near_tie(projection.bundle.spacing, radius_), work.slack))
        order_near_ties(projection, scene_, patches_, centre_, column, row, work.slack,
                        work.relations, first, end);
    work.lists.start.push_back(static_cast<std::uint32_t>(work.lists.hits.size()));
}

void Projector::paint_pairs(const Projection& projection, std::size_t tile, Workspace& work,
                            TilePairs& pairs) const {
    const TileBounds bounds = tile_bounds(projection, tile);
    fill_blocks(projection, scene_, patches_, tile, bounds, work);
    pairs.reserve(work.blocks.hits());
    work.unsure_blocks.clear();
    paint(work.views.data(), work.blocks, bounds, pairs, work.unsure_blocks);

    // The lines that the painter left, as lists() would have them.
    const std::size_t blocks = static_cast<std::size_t>(work.blocks.blocks());
    for (const UnsureLines& unsure : work.unsure_blocks)
        for (std::uint32_t left = unsure.lines; left != 0; left &= left - 1) {
            const int line = std::countr_zero(left);
            const std::int32_t row = bounds.top + static_cast<std::int32_t>(unsure.block / blocks);
            const std::int32_t column =
                bounds.left + static_cast<std::int32_t>(unsure.block % blocks) * block_lines + line;
            std::size_t begin = work.lists.hits.size();
            for (const BlockSpan* span = work.blocks.begin(unsure.block);
                 span != work.blocks.end(unsure.block); ++span)
                if (span->lines >> line & 1)
                    work.lists.hits.push_back(hit_at(work.views[span->view], column, row));
            order_list(projection, column, row, begin, work);
        }
    pairs.hits = work.blocks.hits() - work.lists.hits.size();
}

void Projector::layer_pairs(const Projection& projection, std::size_t tile, Workspace& work,
                            TilePairs& pairs) const {
    const std::uint32_t begin = projection.tile_start[tile], end = projection.tile_start[tile + 1];
    const MeshTile mesh{projection,
                        scene_,
                        patches_,
                        tile_bounds(projection, tile),
                        projection.tile_surfaces.data() + begin,
                        end - begin,
                        near_tie(projection.bundle.spacing, radius_)};
    fill_layers(mesh, work.layers);
    pairs.reserve(work.layers.hits());
    work.view_cache.reset(mesh.count);
    work.left_lines.clear();
    const KeyTies ties(mesh, work.layers, centre_, work.slack, work.relations);
    pair_layers(mesh, work.layers, work.view_cache, ties, pairs, work.left_lines);

    // The lines that were left, as lists() would have them.
    for (std::int32_t line : work.left_lines) {
        const std::int32_t row = mesh.bounds.top + line / HitLayers::side;
        const std::int32_t column = mesh.bounds.left + line % HitLayers::side;
        const std::size_t first = work.lists.hits.size();
        work.keys.clear();
        work.layers.append_keys(line, work.keys);
        for (HitKey key : work.keys) {
            const SurfaceView& view =
                work.view_cache.of(mesh, static_cast<std::uint32_t>(key) >> 1);
            work.slack[view.surface] = view.moved;
            work.lists.hits.push_back(hit_at(view, column, row));
        }
        order_list(projection, column, row, first, work);
    }
}

void Projector::pairs(const Projection& projection, std::size_t tile, Workspace& work,
                      TilePairs& pairs) const {
    pairs.clear();
    work.lists.start.assign(1, 0);
    work.lists.hits.clear();
    work.slack.resize(scene_.surfaces.size());
    if (paintable(projection, tile))
        paint_pairs(projection, tile, work, pairs);
    else
        layer_pairs(projection, tile, work, pairs);
    append_pairs(work.lists, pairs);
    pairs.lines = tile_bounds(projection, tile).lines();
}

}  // namespace parallux
