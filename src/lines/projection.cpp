#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/ball.h"
#include "lines/facets.h"
#include "lines/fill_surface.h"
#include "lines/hit_layers.h"
#include "lines/painter.h"
#include "lines/plane_sides.h"
#include "lines/rectangle.h"
#include "lines/sheets.h"
#include "parallel.h"
#include "parallux/error.h"
#include "parallux/lines.h"

namespace parallux {

namespace {
constexpr std::int32_t most_lines_a_side = 1 << 18;
}

void check_spacing(double spacing, double radius) {
    if (radius / spacing * 2 > most_lines_a_side)
        throw Error(Fault::usage, "a line spacing of " + std::to_string(spacing) +
                                      " m gives more than 262144 lines across the scene; "
                                      "choose a larger --line-spacing");
}

namespace {

// Nothing for planar scenes.
std::shared_ptr<const Facets> facets_of(const Scene& scene, const Patches& patches,
                                        double spacing) {
    if (!has_curves(scene))
        return nullptr;
    return std::make_shared<Facets>(make_facets(scene, patches, facet_chord(scene, spacing)));
}

}  // namespace

Projector::Projector(const Scene& scene, const Patches& patches, Surfaces surfaces, double spacing)
    : facets_(facets_of(scene, patches, spacing)),
      scene_(facets_ ? facets_->scene : scene),
      patches_(facets_ ? facets_->patches : patches),
      sheets_(sheet_faces(scene_)) {
    LineSphere sphere = line_sphere(scene_);
    centre_ = sphere.centre;
    radius_ = sphere.radius;
    if (surfaces == Surfaces::any && scene_.surfaces.size() <= PlaneSides::most_surfaces)
        sides_ = std::make_shared<PlaneSides>(scene_);
}

namespace {

constexpr std::size_t corners_a_piece = 1 << 14, surfaces_a_piece = 1 << 14;

// The smallest and largest snapped coordinates, of some corners or all.
struct Extent {
    std::int32_t left = INT32_MAX, right = INT32_MIN, top = INT32_MAX, bottom = INT32_MIN;

    void add(const Extent& other) {
        left = std::min(left, other.left);
        right = std::max(right, other.right);
        top = std::min(top, other.top);
        bottom = std::max(bottom, other.bottom);
    }
};

Extent extent_of(const Projection::Ball& ball) {
    auto fixed = [](double at) { return static_cast<std::int32_t>(at * fixed_one); };
    constexpr double room = 2.0 / fixed_one;
    return {fixed(ball.x - ball.radius - room), fixed(ball.x + ball.radius + room),
            fixed(ball.y - ball.radius - room), fixed(ball.y + ball.radius + room)};
}

// Snaps every corner to the fixed-point grid.
Extent snap_corners(const Bundle& bundle, const Scene& scene, const glm::dvec3& centre,
                    unsigned threads, Projection& projection) {
    const std::size_t count = scene.positions.size();
    projection.corners.resize(count);
    const glm::dvec3 x = bundle.x * (1 / bundle.spacing), y = bundle.y * (1 / bundle.spacing);
    const double radius = projection.radius;
    std::vector<Extent> extents((count + corners_a_piece - 1) / corners_a_piece);
    parallel_for(
        threads, count, corners_a_piece, [&](std::size_t begin, std::size_t end, unsigned) {
            Extent extent;
            for (std::size_t p = begin; p < end; ++p) {
                const glm::dvec3 from_centre = scene.positions[p] - centre;
                Projection::Corner& corner = projection.corners[p];
                corner.x = static_cast<std::int32_t>(
                    std::lrint((glm::dot(from_centre, x) + bundle.offset_x) * fixed_one));
                corner.y = static_cast<std::int32_t>(
                    std::lrint((glm::dot(from_centre, y) + bundle.offset_y) * fixed_one));
                corner.depth = static_cast<float>(glm::dot(from_centre, bundle.direction) / radius);
                extent.add({corner.x, corner.x, corner.y, corner.y});
            }
            extents[begin / corners_a_piece] = extent;
        });
    Extent all;
    for (const Extent& extent : extents)
        all.add(extent);
    return all;
}

// Which tiles some surfaces may meet: the tiles that their rectangles touch.
void find_tiles(const Scene& scene, std::size_t begin, std::size_t end, Projection& projection,
                Projection::Piece& piece) {
    const int column_bits = std::countr_zero(static_cast<unsigned>(projection.tile_columns));
    const int row_bits = std::countr_zero(static_cast<unsigned>(projection.tile_rows));
    piece.entries.clear();
    piece.place.assign(projection.tiles(), 0);
    for (std::size_t k = begin; k < end; ++k) {
        const std::uint32_t s =
            projection.order.empty() ? static_cast<std::uint32_t>(k) : projection.order[k];
        Rectangle r = rectangle_of(projection, scene.surfaces[s]);
        r = {std::max(r.left, projection.left),
             std::min(r.right, projection.left + projection.columns),
             std::max(r.top, projection.top), std::min(r.bottom, projection.top + projection.rows)};
        if (r.empty())
            continue;
        const std::int32_t x0 = (r.left - projection.left) >> column_bits;
        const std::int32_t x1 = (r.right - 1 - projection.left) >> column_bits;
        const std::int32_t y0 = (r.top - projection.top) >> row_bits;
        const std::int32_t y1 = (r.bottom - 1 - projection.top) >> row_bits;
        for (std::int32_t ty = y0; ty <= y1; ++ty)
            for (std::int32_t tx = x0; tx <= x1; ++tx) {
                const std::uint32_t tile = static_cast<std::uint32_t>(ty * projection.tiles_x + tx);
                piece.entries.push_back({tile, s});
                ++piece.place[tile];
            }
    }
}

}  // namespace

void Projector::project(const Bundle& bundle, Projection& projection, unsigned threads,
                        const LineWindow* window) const {
    check_spacing(bundle.spacing, radius_);
    projection.bundle = bundle;
    projection.radius = radius_;
    Extent extent = snap_corners(bundle, scene_, centre_, threads, projection);
    project_balls(bundle, scene_, centre_, projection);
    for (const Projection::Ball& ball : projection.balls)
        extent.add(extent_of(ball));
    LineWindow seen{first_line(extent.left), first_line(extent.right), first_line(extent.top),
                    first_line(extent.bottom)};
    if (window)
        seen = {std::max(seen.left, window->left), std::min(seen.right, window->right),
                std::max(seen.top, window->top), std::min(seen.bottom, window->bottom)};
    projection.left = seen.left;
    projection.top = seen.top;
    projection.columns = std::max(0, seen.right - seen.left);
    projection.rows = std::max(0, seen.bottom - seen.top);
    // Surfaces that are painted cover many lines: wide tiles cut them less. Where a tile may hold
    // too many to be painted, or none is, it must not be wider than layers of hits.
    projection.tile_columns =
        sides_ && scene_.surfaces.size() <= BlockLists::most_views ? 128 : HitLayers::side;
    projection.tile_rows = most_tile_rows;
    projection.tiles_x =
        (projection.columns + projection.tile_columns - 1) / projection.tile_columns;
    projection.tiles_y = (projection.rows + projection.tile_rows - 1) / projection.tile_rows;
    if (sides_)
        sides_->order(projection, scene_, projection.order);
    sort_into_tiles(projection, threads);
}

// Counts what each piece of the surfaces has for every tile, gives every piece its place in every
// tile, and puts it there: each tile then has its surfaces in their order, whatever the threads.
void Projector::sort_into_tiles(Projection& projection, unsigned threads) const {
    const std::size_t count = scene_.surfaces.size(), tiles = projection.tiles();
    // Of many tiles, fewer and larger pieces, so that counters stay fewer than surfaces.
    const std::size_t grain = std::max(surfaces_a_piece, tiles);
    projection.pieces.resize((count + grain - 1) / grain);
    parallel_for(threads, count, grain, [&](std::size_t begin, std::size_t end, unsigned) {
        find_tiles(scene_, begin, end, projection, projection.pieces[begin / grain]);
    });
    projection.tile_start.resize(tiles + 1);
    std::uint32_t placed = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        projection.tile_start[tile] = placed;
        for (Projection::Piece& piece : projection.pieces)
            placed += std::exchange(piece.place[tile], placed);
    }
    projection.tile_start[tiles] = placed;
    projection.tile_surfaces.resize(placed);
    parallel_for(threads, projection.pieces.size(), 1,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t k = begin; k < end; ++k) {
                         Projection::Piece& piece = projection.pieces[k];
                         for (const Projection::TileEntry& entry : piece.entries)
                             projection.tile_surfaces[piece.place[entry.tile]++] = entry.surface;
                     }
                 });
}

}  // namespace parallux
