#include "lines/periodic.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "lines/tile_bounds.h"

namespace parallux {

namespace {

std::vector<glm::dvec3> periods_of(const Scene& scene) {
    std::vector<glm::dvec3> periods;
    for (const glm::dvec3& period : scene.period)
        if (glm::length(period) > 0)
            periods.push_back(period);
    return periods;
}

// The axis that directions must not come near to: with two periods the plane's normal, which they
// must not be across; with one the period, which they must not be along.
struct Limit {
    glm::dvec3 axis;
    double sine;
};

Limit limit_of(const Scene& scene, const std::vector<glm::dvec3>& periods) {
    const glm::dvec3 axis =
        glm::normalize(periods.size() == 2 ? glm::cross(periods[0], periods[1]) : periods[0]);
    // What a line has to pass: the height of the tile, or with one period its cross-section.
    double low = 0, high = 0, across = 0;
    const Bounds bounds = scene_bounds(scene);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    for (const glm::dvec3& p : scene.positions) {
        const double height = glm::dot(p - middle, axis);
        low = std::min(low, height);
        high = std::max(high, height);
        across = std::max(across, glm::length(p - middle - height * axis));
    }
    double period = glm::length(periods[0]);
    if (periods.size() == 2)
        period = std::min(period, glm::length(periods[1]));
    const double passed = periods.size() == 2 ? high - low : 2 * across;
    return {axis, std::clamp(passed / (period * most_copies), 1e-6, 0.5)};
}

// Turns a direction away from the limit.
glm::dvec3 tilted(const glm::dvec3& direction, const Limit& limit, bool two) {
    const double along = glm::dot(direction, limit.axis);
    const double across = std::sqrt(std::max(0.0, 1 - along * along));
    if ((two ? std::fabs(along) : across) >= limit.sine)
        return direction;
    glm::dvec3 side = direction - along * limit.axis, other;
    if (across < 1e-12)
        frame_across(limit.axis, side, other);
    side = glm::normalize(side);
    const double rest = std::sqrt(1 - limit.sine * limit.sine);
    return std::copysign(two ? limit.sine : rest, along) * limit.axis +
           (two ? rest : limit.sine) * side;
}

// Low and high of some numbers.
struct Span1 {
    double low = 1e300, high = -1e300;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

}  // namespace

bool is_periodic(const Scene& scene) {
    return !periods_of(scene).empty();
}

std::string tilt_warning(const Scene& scene) {
    const std::vector<glm::dvec3> periods = periods_of(scene);
    if (periods.empty())
        return "";
    // Of the sphere, the belt about the horizon, or the caps about the one period.
    const double sine = limit_of(scene, periods).sine;
    const double share = periods.size() == 2 ? sine : 1 - std::sqrt(1 - sine * sine);
    if (share < 0.01)
        return "";
    char text[160];
    std::snprintf(text, sizeof text,
                  "%.1f %% of the directions lie so close to the horizon that they would pass more "
                  "than %.0f tiles, and are tilted by up to %.1f degrees",
                  100 * share, most_copies, std::asin(sine) * 180 / pi);
    return text;
}

PeriodicBundle::PeriodicBundle(const Scene& scene, const Patches& patches, const Bundle& bundle)
    : bundle_(bundle), periods_(periods_of(scene)) {
    const bool two = periods_.size() == 2;
    const Limit limit = limit_of(scene, periods_);
    const glm::dvec3 w = bundle_.direction = tilted(bundle.direction, limit, two);
    // Columns along the horizon, or along the one period: the rectangle about the cell is then not
    // much larger than the cell.
    const glm::dvec3 level =
        two ? glm::cross(limit.axis, w) : limit.axis - glm::dot(limit.axis, w) * w;
    frame_across(w, bundle_.x, bundle_.y);
    if (glm::length(level) > 1e-9)
        bundle_.x = glm::normalize(level);
    bundle_.y = glm::cross(w, bundle_.x);
    const Bounds bounds = scene_bounds(scene);
    middle_ = 0.5 * (bounds.low + bounds.high);

    // Dual to the projected periods in the plane across ω.
    glm::dvec3 p[2];
    for (std::size_t k = 0; k < periods_.size(); ++k)
        p[k] = periods_[k] - glm::dot(periods_[k], w) * w;
    if (two) {
        const double area = glm::dot(w, glm::cross(p[0], p[1]));
        along_[0] = glm::cross(p[1], w) / area;
        along_[1] = glm::cross(w, p[0]) / area;
    } else {
        along_[0] = p[0] / glm::dot(p[0], p[0]);
    }
    copy_surfaces(scene, patches);
    projector_ = std::make_shared<Projector>(copies_, cells_, Projector::Surfaces::many);

    // Only lines of the rectangle about the cell.
    const glm::dvec3 from = middle_ - projector_->centre();
    const double spacing = bundle_.spacing;
    auto reach = [&](const glm::dvec3& axis) {
        double half = 0;
        for (std::size_t k = 0; k < periods_.size(); ++k)
            half += 0.5 * std::fabs(glm::dot(p[k], axis));
        return half / spacing + 1;
    };
    const double x = glm::dot(from, bundle_.x) / spacing + bundle_.offset_x,
                 y = glm::dot(from, bundle_.y) / spacing + bundle_.offset_y;
    LineWindow window;
    window.left = static_cast<std::int32_t>(std::floor(x - reach(bundle_.x)));
    window.right = static_cast<std::int32_t>(std::ceil(x + reach(bundle_.x))) + 1;
    if (two) {
        window.top = static_cast<std::int32_t>(std::floor(y - reach(bundle_.y)));
        window.bottom = static_cast<std::int32_t>(std::ceil(y + reach(bundle_.y))) + 1;
    }
    projector_->project(bundle_, projection_, 1, &window);
}

glm::dvec2 PeriodicBundle::cell_place(const glm::dvec3& position) const {
    const glm::dvec3 from = position - middle_;
    return {glm::dot(from, along_[0]), glm::dot(from, along_[1])};
}

// Every copy of every surface whose shadow along ω overlaps the cell, -1/2 … 1/2 in each period.
void PeriodicBundle::copy_surfaces(const Scene& scene, const Patches& patches) {
    const bool two = periods_.size() == 2;
    constexpr double half = 0.5 + 1e-9;
    // A line's own shadow runs along ω's: across that the copies of a steep wall are few.
    glm::dvec2 across(0);
    if (two) {
        const glm::dvec3 axis = glm::normalize(glm::cross(periods_[0], periods_[1]));
        across = {-glm::dot(axis, along_[1]), glm::dot(axis, along_[0])};
        const double size = std::fabs(across.x) + std::fabs(across.y);
        across = size > 1e-12 ? across / size : glm::dvec2(0, 1);
    }
    std::unordered_map<std::uint64_t, std::uint32_t> corners;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        Span1 x, y, z;
        for (std::uint32_t corner : scene.surfaces[s].corner)
            if (corner != none) {
                const glm::dvec2 place = cell_place(scene.positions[corner]);
                x.add(place.x);
                y.add(place.y);
                z.add(glm::dot(across, place));
            }
        const auto first = static_cast<std::int32_t>(std::ceil(-half - x.high)),
                   last = static_cast<std::int32_t>(std::floor(half - x.low));
        for (std::int32_t i = first; i <= last; ++i) {
            double low = two ? -half - y.high : 0, high = two ? half - y.low : 0;
            if (two && std::fabs(across.y) > 1e-6) {
                // |across · (place + (i, j))| ≤ 1/2 for some place of the surface.
                const double a = (-half - z.high - across.x * i) / across.y,
                             b = (half - z.low - across.x * i) / across.y;
                low = std::max(low, std::min(a, b));
                high = std::min(high, std::max(a, b));
            }
            for (auto j = static_cast<std::int32_t>(std::ceil(low)); j <= high; ++j) {
                Surface copy = scene.surfaces[s];
                glm::dvec3 by = static_cast<double>(i) * periods_[0];
                if (two)
                    by += static_cast<double>(j) * periods_[1];
                for (std::uint32_t& corner : copy.corner) {
                    if (corner == none)
                        continue;
                    const std::uint64_t key = (std::uint64_t(corner) << 32) |
                                              (std::uint64_t(static_cast<std::uint16_t>(i)) << 16) |
                                              static_cast<std::uint16_t>(j);
                    const auto [known, is_new] = corners.try_emplace(
                        key, static_cast<std::uint32_t>(copies_.positions.size()));
                    if (is_new)
                        copies_.positions.push_back(scene.positions[corner] + by);
                    corner = known->second;
                }
                copies_.surfaces.push_back(copy);
                cells_.grids.push_back(patches.grids[s]);
            }
        }
    }
}

bool PeriodicBundle::in_cell(std::int32_t column, std::int32_t row) const {
    const glm::dvec3 point =
        projector_->centre() + bundle_.spacing * ((column - bundle_.offset_x) * bundle_.x +
                                                  (row - bundle_.offset_y) * bundle_.y);
    const glm::dvec2 place = cell_place(point);
    auto inside = [](double x) { return x >= -0.5 && x < 0.5; };
    return inside(place.x) && (periods_.size() == 1 || inside(place.y));
}

void PeriodicBundle::pairs(std::size_t tile, Projector::Workspace& workspace,
                           IntersectionLists& lists, TilePairs& pairs) const {
    pairs.clear();
    projector_->lists(projection_, tile, workspace, lists);
    const TileBounds bounds = tile_bounds(projection_, tile);
    std::uint32_t kept = 0, hits = 0, begin = lists.start[0];
    std::size_t line = 0;
    for (std::int32_t row = bounds.top; row < bounds.bottom; ++row)
        for (std::int32_t column = bounds.left; column < bounds.right; ++column, ++line) {
            const std::uint32_t end = lists.start[line + 1];
            if (in_cell(column, row)) {
                std::copy(lists.hits.begin() + begin, lists.hits.begin() + end,
                          lists.hits.begin() + hits);
                hits += end - begin;
                lists.start[++kept] = hits;
            }
            begin = end;
        }
    lists.start.resize(kept + 1);
    lists.hits.resize(hits);
    append_pairs(lists, pairs);
}

}  // namespace parallux
