#include "lines/plane_sides.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/facets.h"
#include "lines/rectangle.h"

namespace parallux {

namespace {

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

// The point of a planar surface that is nearest to another point.
glm::dvec3 nearest_point(const Scene& scene, const Surface& surface, const glm::dvec3& to) {
    const unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
    const glm::dvec3 normal = surface_normal(scene, surface);
    auto corner = [&](unsigned k) { return scene.positions[surface.corner[k % corners]]; };
    bool above = true;
    glm::dvec3 nearest = corner(0);
    for (unsigned k = 0; k < corners; ++k) {
        const glm::dvec3 from = corner(k), edge = corner(k + 1) - from, way = to - from;
        above = above && glm::dot(glm::cross(normal, edge), way) >= 0;
        const double length = glm::dot(edge, edge);
        const double along = length > 0 ? std::clamp(glm::dot(way, edge) / length, 0.0, 1.0) : 0.0;
        const glm::dvec3 here = from + along * edge;
        if (glm::distance(here, to) < glm::distance(nearest, to))
            nearest = here;
    }
    return above ? to - glm::dot(to - corner(0), normal) * normal : nearest;
}

}  // namespace

PlaneSides::PlaneSides(const Scene& scene)
    : count_(scene.surfaces.size()), sides_(count_ * count_, 0) {
    for (const Surface& surface : scene.surfaces)
        normals_.push_back(surface_normal(scene, surface));
    const double nothing = 1e-9 * line_sphere(scene).radius;
    beside_.resize(count_);
    for (std::size_t a = 0; a < count_; ++a) {
        if (scene.surfaces[a].is_curved()) {
            for (const Surface& other : scene.surfaces)
                beside_[a].push_back(beside(scene, scene.surfaces[a], other));
            continue;
        }
        const glm::dvec3 origin = scene.positions[scene.surfaces[a].corner[0]];
        for (std::size_t b = 0; b < count_; ++b) {
            bool above = false, below = false;
            for (std::uint32_t corner : scene.surfaces[b].corner)
                if (corner != none) {
                    double height = glm::dot(normals_[a], scene.positions[corner] - origin);
                    above = above || height > nothing;
                    below = below || height < -nothing;
                }
            sides_[a * count_ + b] = static_cast<std::int8_t>(int(above) - int(below));
        }
    }
}

PlaneSides::Beside PlaneSides::beside(const Scene& scene, const Surface& ball,
                                      const Surface& other) {
    const glm::dvec3 centre = scene.positions[ball.corner[0]];
    const double radius = scene.curves[ball.curve].radius;
    if (other.is_curved()) {
        const glm::dvec3 way = scene.positions[other.corner[0]] - centre;
        const double distance = glm::length(way), reach = scene.curves[other.curve].radius;
        return {distance >= radius + reach && distance > 0 ? way / distance : glm::dvec3(0),
                distance + reach <= radius};
    }
    bool within = true;
    for (std::uint32_t corner : other.corner)
        within =
            within && (corner == none || glm::distance(scene.positions[corner], centre) <= radius);
    const glm::dvec3 way = nearest_point(scene, other, centre) - centre;
    const double distance = glm::length(way);
    return {distance >= radius ? way / distance : glm::dvec3(0), within};
}

int PlaneSides::half_order(const Scene& scene, std::size_t ball, std::size_t other,
                           const glm::dvec3& direction) const {
    const bool far = is_far_half(scene.surfaces[ball]);
    const Beside& lies = beside_[ball][other];
    if (lies.within || scene.surfaces[ball].curve == scene.surfaces[other].curve)
        return far ? -1 : 1;
    const double along = glm::dot(lies.toward, direction);
    return along == 0 ? 0 : along > 0 ? 1 : -1;
}

void PlaneSides::order(const Projection& projection, const Scene& scene,
                       std::vector<std::uint32_t>& surfaces) const {
    std::vector<Rectangle> seen(count_);
    std::vector<std::int8_t> facing(count_);
    for (std::size_t s = 0; s < count_; ++s) {
        seen[s] = rectangle_of(projection, scene.surfaces[s]);
        facing[s] = glm::dot(normals_[s], projection.bundle.direction) > 0 ? 1 : -1;
    }
    // a comes before b when b lies beyond a's plane, or a on the near side of b's; 0: no plane
    // tells.
    auto order_of = [&](std::size_t a, std::size_t b) {
        const glm::dvec3& direction = projection.bundle.direction;
        if (!beside_[a].empty())
            if (const int order = half_order(scene, a, b, direction); order != 0)
                return order;
        if (!beside_[b].empty())
            return -half_order(scene, b, a, direction);
        int by_a = side(a, b) * facing[a], by_b = side(b, a) * facing[b];
        return by_a != 0 ? by_a : -by_b;
    };
    std::vector<char> before(count_ * count_, 0);
    std::vector<std::uint32_t> earlier(count_, 0);
    for (std::size_t a = 0; a < count_; ++a)
        for (std::size_t b = a + 1; b < count_; ++b) {
            int order = overlap(seen[a], seen[b]) ? order_of(a, b) : 0;
            if (order == 0)
                continue;
            auto [first, second] = order > 0 ? std::pair(a, b) : std::pair(b, a);
            before[first * count_ + second] = 1;
            ++earlier[second];
        }
    // Take those that nothing is left before; in a ring, the one with fewest before it.
    surfaces.clear();
    constexpr std::uint32_t taken = 0xffffffff;
    while (surfaces.size() < count_) {
        std::size_t next = 0;
        for (std::size_t s = 1; s < count_; ++s)
            if (earlier[s] < earlier[next])
                next = s;
        earlier[next] = taken;
        surfaces.push_back(static_cast<std::uint32_t>(next));
        for (std::size_t s = 0; s < count_; ++s)
            if (before[next * count_ + s] && earlier[s] != taken)
                --earlier[s];
    }
}

}  // namespace parallux
