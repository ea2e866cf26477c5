#include <cmath>

#include <glm/geometric.hpp>

#include "scene/mesh_builder.h"

namespace parallux {
namespace {

// Newell's normal: right for concave polygons, too.
glm::dvec3 polygon_normal(const std::vector<glm::dvec3>& positions,
                          const std::vector<std::uint32_t>& corners) {
    glm::dvec3 sum(0), origin = positions[corners[0]];
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += glm::cross(positions[corners[i]] - origin,
                          positions[corners[(i + 1) % corners.size()]] - origin);
    return sum;
}

// Whether the corner between `a` and `c` is convex and no other corner lies in its triangle.
bool is_ear(const std::vector<glm::dvec3>& p, const std::vector<std::uint32_t>& ring,
            std::size_t at, const glm::dvec3& normal) {
    std::size_t n = ring.size();
    std::uint32_t ia = ring[(at + n - 1) % n], ib = ring[at], ic = ring[(at + 1) % n];
    auto side = [&](const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& x) {
        return glm::dot(normal, glm::cross(to - from, x - from));
    };
    if (side(p[ia], p[ib], p[ic]) <= 0)
        return false;
    for (std::uint32_t i : ring) {
        if (i == ia || i == ib || i == ic || p[i] == p[ia] || p[i] == p[ib] || p[i] == p[ic])
            continue;
        if (side(p[ia], p[ib], p[i]) >= 0 && side(p[ib], p[ic], p[i]) >= 0 &&
            side(p[ic], p[ia], p[i]) >= 0)
            return false;
    }
    return true;
}

}  // namespace

void triangulate(const std::vector<glm::dvec3>& positions,
                 const std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& indices) {
    std::vector<std::uint32_t> ring = corners;
    auto cut = [&](std::size_t at) {
        std::size_t n = ring.size();
        indices.insert(indices.end(), {ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
    };
    if (ring.size() > 3 && ring.size() <= 1024) {
        glm::dvec3 normal = polygon_normal(positions, ring);
        // Each round begins where the last one cut: a convex polygon becomes a fan in one pass.
        for (std::size_t at = 1; ring.size() > 3;) {
            std::size_t tried = 0;
            while (tried < ring.size() && !is_ear(positions, ring, at % ring.size(), normal))
                ++at, ++tried;
            if (tried == ring.size())
                break;  // self-intersecting or without area: a fan as good as any
            at %= ring.size();
            cut(at);
        }
    }
    while (ring.size() > 3)
        cut(1);
    indices.insert(indices.end(), ring.begin(), ring.end());
}

}  // namespace parallux
