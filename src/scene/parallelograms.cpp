#include "scene/parallelograms.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {
namespace {

// Half-edges by their two corners, chained in buckets. Half-edge 3t + k runs from corner k to
// corner k + 1 of triangle t, so its apex is corner k + 2.
class EdgeTable {
public:
    explicit EdgeTable(const std::vector<MeshTriangle>& triangles)
        : triangles_(triangles),
          heads_(std::bit_ceil(3 * triangles.size() + 1), none),
          next_(3 * triangles.size(), none) {
        // From the last to the first, so that a chain runs in the file's order.
        for (std::size_t h = next_.size(); h-- > 0;) {
            auto [from, to] = ends(static_cast<std::uint32_t>(h));
            std::uint32_t& head = heads_[bucket(from, to)];
            next_[h] = head;
            head = static_cast<std::uint32_t>(h);
        }
    }

    std::pair<std::uint32_t, std::uint32_t> ends(std::uint32_t h) const {
        const auto& corner = triangles_[h / 3].corner;
        return {corner[h % 3], corner[(h + 1) % 3]};
    }

    /// Calls visit(half-edge) for those from → to until it returns true. An edge of more than 32
    /// faces is no parallelogram's diagonal; going on would make a hostile file quadratic.
    template <class Visit>
    void find(std::uint32_t from, std::uint32_t to, const Visit& visit) const {
        int steps = 0;
        for (std::uint32_t h = heads_[bucket(from, to)]; h != none && steps < 32; h = next_[h]) {
            ++steps;
            if (ends(h) == std::pair(from, to) && visit(h))
                return;
        }
    }

private:
    std::size_t bucket(std::uint32_t from, std::uint32_t to) const {
        std::uint64_t key = std::uint64_t(from) << 32 | to;
        key *= 0x9E3779B97F4A7C15u;
        return (key ^ key >> 32) & (heads_.size() - 1);
    }

    const std::vector<MeshTriangle>& triangles_;
    std::vector<std::uint32_t> heads_, next_;
};

double longest_edge(const std::vector<glm::dvec3>& p, const MeshTriangle& t) {
    const auto& c = t.corner;
    return std::max({glm::distance(p[c[0]], p[c[1]]), glm::distance(p[c[1]], p[c[2]]),
                     glm::distance(p[c[2]], p[c[0]])});
}

// Coordinates are floats in most files: a corner far from the origin is off by its own rounding.
bool fourth_corner_fits(const std::vector<glm::dvec3>& p, const MeshTriangle& a, int apex,
                        const MeshTriangle& b, int other_apex) {
    glm::dvec3 p0 = p[a.corner[apex]], p1 = p[a.corner[(apex + 1) % 3]];
    glm::dvec3 p3 = p[a.corner[(apex + 2) % 3]], p2 = p[b.corner[other_apex]];
    double edge = longest_edge(p, a);
    glm::dvec3 size = glm::abs(p2);
    double magnitude = std::max({size.x, size.y, size.z});
    double tolerance = std::min(1e-6 * edge + 2.4e-7 * magnitude, 1e-5 * edge);
    return glm::distance(p2, p1 + (p3 - p0)) <= tolerance;
}

}  // namespace

std::vector<Partner> find_parallelograms(const std::vector<glm::dvec3>& positions,
                                         const std::vector<MeshTriangle>& triangles,
                                         const SameAttributes& same_attributes) {
    std::vector<Partner> partners(triangles.size());
    EdgeTable edges(triangles);

    auto join_over = [&](std::uint32_t h) {
        std::uint32_t t = h / 3;
        int apex = static_cast<int>((h % 3 + 2) % 3);
        auto [from, to] = edges.ends(h);
        edges.find(to, from, [&](std::uint32_t other) {
            std::uint32_t o = other / 3;
            int other_apex = static_cast<int>((other % 3 + 2) % 3);
            if (o == t || partners[o].triangle != none ||
                !fourth_corner_fits(positions, triangles[t], apex, triangles[o], other_apex) ||
                !same_attributes(triangles[t], apex, triangles[o], other_apex))
                return false;
            partners[t] = {o, std::uint8_t(apex), std::uint8_t(other_apex)};
            partners[o] = {t, std::uint8_t(other_apex), std::uint8_t(apex)};
            return true;
        });
    };

    // In a regular grid every neighbour completes a parallelogram. The longest edge is the
    // rectangle's diagonal, so those are joined first, over the whole mesh.
    for (bool longest_only : {true, false})
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            double longest = (1 - 1e-6) * longest_edge(positions, triangles[t]);
            for (std::uint32_t k = 0; k < 3 && partners[t].triangle == none; ++k) {
                auto [from, to] = edges.ends(3 * t + k);
                if (!longest_only || glm::distance(positions[from], positions[to]) >= longest)
                    join_over(3 * t + k);
            }
        }
    return partners;
}

}  // namespace parallux
