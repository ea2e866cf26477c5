#include "lines/periodic.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "lines/tile_bounds.h"
#include "parallux/error.h"

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

// A bundle that keeps off the limit, with columns along the horizon, or along the one period: the
// rectangle about the cell is then not much larger than the cell.
Bundle level_bundle(const Scene& scene, const Bundle& bundle) {
    const std::vector<glm::dvec3> periods = periods_of(scene);
    const bool two = periods.size() == 2;
    const Limit limit = limit_of(scene, periods);
    Bundle turned = bundle;
    const glm::dvec3 w = turned.direction = tilted(bundle.direction, limit, two);
    const glm::dvec3 level =
        two ? glm::cross(limit.axis, w) : limit.axis - glm::dot(limit.axis, w) * w;
    frame_across(w, turned.x, turned.y);
    if (glm::length(level) > 1e-9)
        turned.x = glm::normalize(level);
    turned.y = glm::cross(w, turned.x);
    return turned;
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

void check_copies(const Scene& scene, double radius, double spacing) {
    double period = 0;
    for (const glm::dvec3& p : periods_of(scene))
        period = std::max(period, glm::length(p));
    const double lines = (2 * radius + (most_copies + 4) * period) / spacing;
    if (period > 0 && lines > 1 << 18)
        throw Error(Fault::usage,
                    "the line spacing is too small for a periodic scene, which takes "
                    "up to 64 copies of the tile: choose a larger --line-spacing");
}

PeriodicCell::PeriodicCell(const Scene& scene, const glm::dvec3& direction)
    : periods_(periods_of(scene)) {
    const Bounds bounds = scene_bounds(scene);
    middle_ = 0.5 * (bounds.low + bounds.high);
    for (std::size_t k = 0; k < periods_.size(); ++k)
        seen_[k] = periods_[k] - glm::dot(periods_[k], direction) * direction;
    // Dual to the projected periods in the plane across ω.
    if (!two()) {
        along_[0] = seen_[0] / glm::dot(seen_[0], seen_[0]);
        return;
    }
    const double area = glm::dot(direction, glm::cross(seen_[0], seen_[1]));
    along_[0] = glm::cross(seen_[1], direction) / area;
    along_[1] = glm::cross(direction, seen_[0]) / area;
    // A line's own shadow runs along ω's: across that the copies of a steep wall are few.
    const glm::dvec3 axis = glm::normalize(glm::cross(periods_[0], periods_[1]));
    across_ = {-glm::dot(axis, along_[1]), glm::dot(axis, along_[0])};
    const double size = std::fabs(across_.x) + std::fabs(across_.y);
    across_ = size > 1e-12 ? across_ / size : glm::dvec2(0, 1);
}

glm::dvec2 PeriodicCell::place(const glm::dvec3& position) const {
    const glm::dvec3 from = position - middle_;
    return {glm::dot(from, along_[0]), glm::dot(from, along_[1])};
}

template <class Visit>
void PeriodicCell::each_copy(const Scene& scene, const Surface& surface, Visit&& visit) const {
    constexpr double half = 0.5 + 1e-9;
    Span1 x, y, z;
    for (std::uint32_t corner : surface.corner)
        if (corner != none) {
            const glm::dvec2 at = place(scene.positions[corner]);
            x.add(at.x);
            y.add(at.y);
            z.add(glm::dot(across_, at));
        }
    const auto first = static_cast<std::int32_t>(std::ceil(-half - x.high)),
               last = static_cast<std::int32_t>(std::floor(half - x.low));
    for (std::int32_t i = first; i <= last; ++i) {
        double low = two() ? -half - y.high : 0, high = two() ? half - y.low : 0;
        if (two() && std::fabs(across_.y) > 1e-6) {
            // |across · (place + (i, j))| ≤ 1/2 for some place of the surface.
            const double a = (-half - z.high - across_.x * i) / across_.y,
                         b = (half - z.low - across_.x * i) / across_.y;
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        }
        for (auto j = static_cast<std::int32_t>(std::ceil(low)); j <= high; ++j)
            visit(i, j);
    }
}

std::uint64_t most_copied_surfaces(const Scene& scene) {
    const std::vector<glm::dvec3> periods = periods_of(scene);
    if (periods.empty())
        return 0;
    // Most copies are met where directions are tilted: those all around the axis, and a quarter
    // more for what lies between them.
    constexpr int around = 64;
    const Limit limit = limit_of(scene, periods);
    glm::dvec3 x, y;
    frame_across(limit.axis, x, y);
    std::uint64_t most = 0;
    for (int k = 0; k < around; ++k) {
        const double angle = pi * (k + 0.5) / around;
        const glm::dvec3 side = std::cos(angle) * x + std::sin(angle) * y;
        const glm::dvec3 raw = periods.size() == 2 ? side : limit.axis + 1e-9 * side;
        const PeriodicCell cell(scene, tilted(glm::normalize(raw), limit, periods.size() == 2));
        std::uint64_t copies = 0;
        for (const Surface& surface : scene.surfaces)
            cell.each_copy(scene, surface, [&](std::int32_t, std::int32_t) { ++copies; });
        most = std::max(most, copies);
    }
    return most + most / 4;
}

std::uint64_t copies_bytes(const Scene& scene) {
    // Arrays that grow hold up to twice their content. A corner has its place, its entry in the
    // table of known ones, and its projection; surfaces share corners as they do in the tile.
    constexpr std::uint64_t a_surface = 2 * (sizeof(Surface) + sizeof(SurfaceGrid)) + 40,
                            a_corner = 2 * sizeof(glm::dvec3) + 48 + 12;
    const double corners = static_cast<double>(scene.positions.size()) /
                           static_cast<double>(std::max<std::size_t>(1, scene.surfaces.size()));
    return most_copied_surfaces(scene) *
           (a_surface + static_cast<std::uint64_t>(corners * double(a_corner)));
}

PeriodicBundle::PeriodicBundle(const Scene& scene, const Patches& patches, const Bundle& bundle)
    : bundle_(level_bundle(scene, bundle)), cell_(scene, bundle_.direction) {
    copy_surfaces(scene, patches);
    projector_ = std::make_shared<Projector>(copies_, cells_, Projector::Surfaces::many);

    // Only lines of the rectangle about the cell.
    const glm::dvec3 from = cell_.middle() - projector_->centre();
    const double spacing = bundle_.spacing;
    auto reach = [&](const glm::dvec3& axis) {
        double half = 0;
        for (std::size_t k = 0; k < cell_.periods().size(); ++k)
            half += 0.5 * std::fabs(glm::dot(cell_.seen(k), axis));
        return half / spacing + 1;
    };
    const double x = glm::dot(from, bundle_.x) / spacing + bundle_.offset_x,
                 y = glm::dot(from, bundle_.y) / spacing + bundle_.offset_y;
    LineWindow window;
    window.left = static_cast<std::int32_t>(std::floor(x - reach(bundle_.x)));
    window.right = static_cast<std::int32_t>(std::ceil(x + reach(bundle_.x))) + 1;
    if (cell_.two()) {
        window.top = static_cast<std::int32_t>(std::floor(y - reach(bundle_.y)));
        window.bottom = static_cast<std::int32_t>(std::ceil(y + reach(bundle_.y))) + 1;
    }
    projector_->project(bundle_, projection_, 1, &window);
}

// Every copy of every surface whose shadow along ω overlaps the cell.
void PeriodicBundle::copy_surfaces(const Scene& scene, const Patches& patches) {
    std::unordered_map<std::uint64_t, std::uint32_t> corners;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        cell_.each_copy(scene, scene.surfaces[s], [&](std::int32_t i, std::int32_t j) {
            Surface copy = scene.surfaces[s];
            glm::dvec3 by = static_cast<double>(i) * cell_.periods()[0];
            if (cell_.two())
                by += static_cast<double>(j) * cell_.periods()[1];
            for (std::uint32_t& corner : copy.corner) {
                if (corner == none)
                    continue;
                const std::uint64_t key = (std::uint64_t(corner) << 32) |
                                          (std::uint64_t(static_cast<std::uint16_t>(i)) << 16) |
                                          static_cast<std::uint16_t>(j);
                const auto [known, is_new] =
                    corners.try_emplace(key, static_cast<std::uint32_t>(copies_.positions.size()));
                if (is_new)
                    copies_.positions.push_back(scene.positions[corner] + by);
                corner = known->second;
            }
            copies_.surfaces.push_back(copy);
            cells_.grids.push_back(patches.grids[s]);
        });
}

bool PeriodicBundle::in_cell(std::int32_t column, std::int32_t row) const {
    const glm::dvec3 point =
        projector_->centre() + bundle_.spacing * ((column - bundle_.offset_x) * bundle_.x +
                                                  (row - bundle_.offset_y) * bundle_.y);
    const glm::dvec2 place = cell_.place(point);
    auto inside = [](double x) { return x >= -0.5 && x < 0.5; };
    return inside(place.x) && (!cell_.two() || inside(place.y));
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
