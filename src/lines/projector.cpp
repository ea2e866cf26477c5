#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/depth_order.h"
#include "lines/edge_walk.h"
#include "lines/rectangle.h"
#include "parallux/lines.h"

namespace parallux {

namespace {

// A surface as one tile sees it: (u, v) and depth as affine functions of column and row, and what
// its two sides are called. Counted from a line near the surface, so that floats suffice.
struct SurfaceView {
    std::int32_t column = 0, row = 0;
    float u = 0, u_column = 0, u_row = 0;
    float v = 0, v_column = 0, v_row = 0;
    float depth = 0, depth_u = 0, depth_v = 0;
    std::uint32_t surface = none;
    std::uint32_t toward = none, away = none;  // first patch of either side
    std::uint32_t nu = 1, nv = 1;
    Shape shape = Shape::parallelogram;
};

// A run of lines in one row of a tile that meet one surface.
struct Span {
    std::uint32_t view;
    std::int32_t row, begin, end;  // columns, all from the tile's corner
};

}  // namespace

struct Projector::Workspace {
    std::vector<SurfaceView> views;
    std::vector<Span> spans;
    std::vector<std::uint32_t> cursor;
    std::vector<float> slack;  // one a surface; only those of the present tile are up to date
};

std::shared_ptr<Projector::Workspace> Projector::make_workspace() {
    return std::make_shared<Workspace>();
}

namespace {

// Solves for (u, v) at a line: with the projected axes e_u, e_v and p from the origin corner,
// u = (p × e_v) / (e_u × e_v), v = (e_u × p) / (e_u × e_v). A surface seen exactly from its edge
// covers no line; its inverse is set to 0 to keep numbers finite.
SurfaceView view_of(const Projection& projection, const Scene& scene, const Patches& patches,
                    std::uint32_t s) {
    const Surface& surface = scene.surfaces[s];
    const Projection::Corner& origin = projection.corners[surface.corner[0]];
    const Projection::Corner& end_u = projection.corners[surface.corner[1]];
    const Projection::Corner& end_v = projection.corners[surface.corner_v()];
    constexpr double unit = 1.0 / fixed_one;
    double ux = (static_cast<double>(end_u.x) - origin.x) * unit;
    double uy = (static_cast<double>(end_u.y) - origin.y) * unit;
    double vx = (static_cast<double>(end_v.x) - origin.x) * unit;
    double vy = (static_cast<double>(end_v.y) - origin.y) * unit;
    double turned = ux * vy - uy * vx;
    double inverse = turned != 0 ? 1 / turned : 0;

    SurfaceView view;
    view.column = origin.x >> fixed_bits;
    view.row = origin.y >> fixed_bits;
    double px = view.column - origin.x * unit, py = view.row - origin.y * unit;
    view.u = static_cast<float>((px * vy - py * vx) * inverse);
    view.u_column = static_cast<float>(vy * inverse);
    view.u_row = static_cast<float>(-vx * inverse);
    view.v = static_cast<float>((ux * py - uy * px) * inverse);
    view.v_column = static_cast<float>(-uy * inverse);
    view.v_row = static_cast<float>(ux * inverse);
    view.depth = origin.depth;
    view.depth_u = end_u.depth - origin.depth;
    view.depth_v = end_v.depth - origin.depth;
    view.surface = s;
    // The front's normal points along the direction when its corners turn from x to y: then the
    // traveller comes upon the back.
    const SurfaceGrid& grid = patches.grids[s];
    view.toward = turned > 0 ? grid.back : grid.front;
    view.away = turned > 0 ? grid.front : grid.back;
    view.nu = grid.nu;
    view.nv = grid.nv;
    view.shape = surface.shape();
    return view;
}

Hit hit_at(const SurfaceView& view, std::int32_t column, std::int32_t row) {
    float x = static_cast<float>(column - view.column), y = static_cast<float>(row - view.row);
    float u = view.u + (view.u_column * x + view.u_row * y);
    float v = view.v + (view.v_column * x + view.v_row * y);
    // Snapping and rounding may leave the surface by a hair.
    u = std::min(std::max(u, 0.0f), 1.0f);
    v = std::min(std::max(v, 0.0f), 1.0f);
    std::uint32_t cell = 0;
    if (view.nu * view.nv > 1)
        cell = cell_at(view.shape, view.nu, view.nv, u, v);
    Hit hit;
    hit.depth = view.depth + (view.depth_u * u + view.depth_v * v);
    hit.surface = view.surface;
    hit.toward = view.toward == none ? none : view.toward + cell;
    hit.away = view.away == none ? none : view.away + cell;
    return hit;
}

bool before(const Hit& a, const Hit& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.surface < b.surface;
}

// How far snapping may have moved a surface's depths: its corners move by half a fixed place in
// either axis at most; twice that.
float slack_of(const SurfaceView& view) {
    float per_column = view.depth_u * view.u_column + view.depth_v * view.v_column;
    float per_row = view.depth_u * view.u_row + view.depth_v * view.v_row;
    return (std::fabs(per_column) + std::fabs(per_row)) / static_cast<float>(fixed_one);
}

// Sorts a list. Returns whether any two hits are so near each other that snapping and rounding may
// have turned them.
bool sort_hits(Hit* begin, Hit* end, float tie, const std::vector<float>& slack) {
    // Lists are mostly 2 to 4 long.
    if (end - begin > 24) {
        std::sort(begin, end, before);
    } else {
        for (Hit* k = begin + 1; k < end; ++k) {
            Hit hit = *k;
            Hit* place = k;
            for (; place > begin && before(hit, place[-1]); --place)
                *place = place[-1];
            *place = hit;
        }
    }
    for (Hit* k = begin + 1; k < end; ++k) {
        float step = k->depth - k[-1].depth;
        if (step < tie || step < slack[k->surface] + slack[k[-1].surface])
            return true;
    }
    return false;
}

// The runs of a surface's lines in a tile, row by row: in each row the edges' columns, sorted,
// bound the runs in pairs. That is right for any polygon, even one that snapping has folded.
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

}  // namespace

void Projector::lists(const Projection& projection, std::size_t tile, Workspace& workspace,
                      IntersectionLists& lists) const {
    std::int32_t left =
        projection.left + static_cast<std::int32_t>(tile % projection.tiles_x) * tile_side;
    std::int32_t top =
        projection.top + static_cast<std::int32_t>(tile / projection.tiles_x) * tile_side;
    std::int32_t right = std::min(left + tile_side, projection.left + projection.columns);
    std::int32_t bottom = std::min(top + tile_side, projection.top + projection.rows);
    std::int32_t columns = right - left;
    std::size_t lines = static_cast<std::size_t>(columns) * (bottom - top);

    // Fill the surfaces of the tile with runs, and count the hits of every line.
    workspace.views.clear();
    workspace.spans.clear();
    workspace.slack.resize(scene_.surfaces.size());
    lists.start.assign(lines + 1, 0);
    for (std::uint32_t k = projection.tile_start[tile]; k < projection.tile_start[tile + 1]; ++k) {
        std::uint32_t s = projection.tile_surfaces[k];
        std::uint32_t view = static_cast<std::uint32_t>(workspace.views.size());
        bool any = false;
        fill_surface(projection, scene_.surfaces[s], left, right, top, bottom,
                     [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
                         any = true;
                         workspace.spans.push_back({view, row - top, begin - left, end - left});
                         std::uint32_t* count = &lists.start[(row - top) * columns + 1];
                         for (std::int32_t column = begin - left; column < end - left; ++column)
                             ++count[column];
                     });
        if (any) {
            workspace.views.push_back(view_of(projection, scene_, patches_, s));
            workspace.slack[s] = slack_of(workspace.views.back());
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
            order_near_ties(projection, scene_, patches_, centre_, radius_,
                            left + static_cast<std::int32_t>(line) % columns,
                            top + static_cast<std::int32_t>(line) / columns, workspace.slack, begin,
                            end);
    }
}

}  // namespace parallux
