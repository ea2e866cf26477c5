#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "lines/fill_surface.h"
#include "lines/plane_sides.h"
#include "lines/rectangle.h"
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

Projector::Projector(const Scene& scene, const Patches& patches)
    : scene_(scene), patches_(patches) {
    LineSphere sphere = line_sphere(scene);
    centre_ = sphere.centre;
    radius_ = sphere.radius;
    if (scene.surfaces.size() <= PlaneSides::most_surfaces)
        sides_ = std::make_shared<PlaneSides>(scene);
}

void Projector::project(const Bundle& bundle, Projection& projection) const {
    check_spacing(bundle.spacing, radius_);
    projection.bundle = bundle;
    projection.radius = radius_;

    // Snap every corner to the fixed-point grid.
    projection.corners.resize(scene_.positions.size());
    glm::dvec3 x = bundle.x * (1 / bundle.spacing), y = bundle.y * (1 / bundle.spacing);
    std::int32_t left = INT32_MAX, right = INT32_MIN, top = INT32_MAX, bottom = INT32_MIN;
    for (std::size_t p = 0; p < scene_.positions.size(); ++p) {
        glm::dvec3 from_centre = scene_.positions[p] - centre_;
        Projection::Corner& corner = projection.corners[p];
        corner.x = static_cast<std::int32_t>(
            std::lrint((glm::dot(from_centre, x) + bundle.offset_x) * fixed_one));
        corner.y = static_cast<std::int32_t>(
            std::lrint((glm::dot(from_centre, y) + bundle.offset_y) * fixed_one));
        corner.depth = static_cast<float>(glm::dot(from_centre, bundle.direction) / radius_);
        left = std::min(left, corner.x);
        right = std::max(right, corner.x);
        top = std::min(top, corner.y);
        bottom = std::max(bottom, corner.y);
    }
    projection.left = first_line(left);
    projection.top = first_line(top);
    projection.columns = std::max(0, first_line(right) - projection.left);
    projection.rows = std::max(0, first_line(bottom) - projection.top);
    // Surfaces that are painted cover many lines: wide tiles cut them less.
    projection.tile_columns = sides_ ? 128 : 64;
    projection.tile_rows = most_tile_rows;
    projection.tiles_x =
        (projection.columns + projection.tile_columns - 1) / projection.tile_columns;
    projection.tiles_y = (projection.rows + projection.tile_rows - 1) / projection.tile_rows;

    if (sides_)
        sides_->order(projection, scene_, projection.order);

    // Sort the surfaces into the tiles that their rectangles touch: count, then place.
    projection.tile_start.assign(projection.tiles() + 1, 0);
    auto each_tile = [&](auto&& visit) {
        for (std::uint32_t k = 0; k < scene_.surfaces.size(); ++k) {
            std::uint32_t s = projection.order.empty() ? k : projection.order[k];
            Rectangle r = rectangle_of(projection, scene_.surfaces[s]);
            if (r.empty())
                continue;
            std::int32_t x0 = (r.left - projection.left) / projection.tile_columns;
            std::int32_t x1 = (r.right - 1 - projection.left) / projection.tile_columns;
            std::int32_t y0 = (r.top - projection.top) / projection.tile_rows;
            std::int32_t y1 = (r.bottom - 1 - projection.top) / projection.tile_rows;
            for (std::int32_t ty = y0; ty <= y1; ++ty)
                for (std::int32_t tx = x0; tx <= x1; ++tx)
                    visit(static_cast<std::size_t>(ty) * projection.tiles_x + tx, s);
        }
    };
    each_tile([&](std::size_t tile, std::uint32_t) { ++projection.tile_start[tile + 1]; });
    for (std::size_t tile = 0; tile < projection.tiles(); ++tile)
        projection.tile_start[tile + 1] += projection.tile_start[tile];
    projection.tile_surfaces.resize(projection.tile_start.back());
    std::vector<std::uint32_t> cursor(projection.tile_start.begin(),
                                      projection.tile_start.end() - 1);
    each_tile(
        [&](std::size_t tile, std::uint32_t s) { projection.tile_surfaces[cursor[tile]++] = s; });
}

}  // namespace parallux
