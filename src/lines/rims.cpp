#include "lines/rims.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace parallux {

namespace {

glm::dvec3 on(const Scene& scene, const Rim& rim, double along) {
    const glm::dvec2 uv = rim.uv_from + along * (rim.uv_to - rim.uv_from);
    return surface_point(scene, scene.surfaces[rim.surface], uv.x, uv.y);
}

// Takes a corner up where it lies on the rim: its nearest point by golden section.
void take(const Scene& scene, Rim& rim, std::uint32_t corner, const glm::dvec3& p,
          double tolerance) {
    double from = 0, to = 1;
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    for (int step = 0; step < 80; ++step) {
        const double a = to - golden * (to - from), b = from + golden * (to - from);
        if (glm::distance(on(scene, rim, a), p) < glm::distance(on(scene, rim, b), p))
            to = b;
        else
            from = a;
    }
    const double along = 0.5 * (from + to);
    // The search ends at half of a double's digits.
    const double length = glm::distance(on(scene, rim, 0), on(scene, rim, 1));
    if (glm::distance(on(scene, rim, along), p) <= 2 * tolerance + 1e-9 * length)
        rim.taken.push_back({along, corner});
}

}  // namespace

void take_corners(const Scene& scene, const std::vector<glm::dvec3>& positions,
                  const FacetLimits& limits, std::size_t curved_rims, std::vector<Rim>& rims) {
    struct Corner {
        double x;
        std::uint32_t number;
        bool curved;
    };
    std::vector<Corner> corners;
    std::vector<std::uint8_t> seen(positions.size(), 0);
    for (std::size_t r = 0; r < rims.size(); ++r)
        for (std::uint32_t corner : {rims[r].from, rims[r].to})
            if (!seen[corner]) {
                seen[corner] = 1;
                corners.push_back({positions[corner].x, corner, r < curved_rims});
            }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return a.x != b.x ? a.x < b.x : a.number < b.number;
    });
    std::vector<Corner> of_curves;
    for (const Corner& corner : corners)
        if (corner.curved)
            of_curves.push_back(corner);
    for (std::size_t r = 0; r < rims.size(); ++r) {
        Rim& rim = rims[r];
        const bool curved = r < curved_rims;
        const glm::dvec3 a = positions[rim.from], b = positions[rim.to];
        const double room =
            limits.same_place +
            (curved ? 1.5 * std::min(limits.chord, limits.bend * glm::distance(a, b)) : 0);
        const glm::dvec3 low = glm::min(a, b) - room, high = glm::max(a, b) + room;
        const std::vector<Corner>& others = curved ? corners : of_curves;
        auto next = std::lower_bound(others.begin(), others.end(), low.x,
                                     [](const Corner& c, double x) { return c.x < x; });
        for (; next != others.end() && next->x <= high.x; ++next) {
            const glm::dvec3& p = positions[next->number];
            if (next->number == rim.from || next->number == rim.to || p.y < low.y || p.y > high.y ||
                p.z < low.z || p.z > high.z)
                continue;
            take(scene, rim, next->number, p, limits.same_place);
        }
        std::sort(rim.taken.begin(), rim.taken.end(), [](const auto& c, const auto& d) {
            return c.along != d.along ? c.along < d.along : c.corner < d.corner;
        });
    }
}

}  // namespace parallux
