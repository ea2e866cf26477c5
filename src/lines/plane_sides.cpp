#include "lines/plane_sides.h"

#include <utility>

#include <glm/geometric.hpp>

#include "lines/rectangle.h"

namespace parallux {

namespace {

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

}  // namespace

PlaneSides::PlaneSides(const Scene& scene)
    : count_(scene.surfaces.size()), sides_(count_ * count_, 0) {
    for (const Surface& surface : scene.surfaces)
        normals_.push_back(surface_normal(scene, surface));
    const double nothing = 1e-9 * line_sphere(scene).radius;
    for (std::size_t a = 0; a < count_; ++a) {
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
