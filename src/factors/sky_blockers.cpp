#include <algorithm>
#include <map>
#include <tuple>

#include <glm/geometric.hpp>

#include "factors/open_sky.h"

namespace parallux {

namespace {

using Place = std::tuple<double, double, double>;

std::uint32_t place_of(const std::array<std::uint32_t, 4>& edges, std::uint32_t edge) {
    return static_cast<std::uint32_t>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
}

}  // namespace

SkyBlockers::SkyBlockers(const Scene& scene) : up_(scene.sky.up) {
    std::map<Place, std::uint32_t> places;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
    for (const Surface& surface : scene.surfaces) {
        Face face{};
        for (std::uint32_t corner : surface.corner) {
            if (corner == none)
                continue;
            const glm::dvec3& p = scene.positions[corner];
            const auto [at, fresh] =
                places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(corners_.size()));
            if (fresh)
                corners_.push_back(p);
            face.corner[face.size++] = at->second;
        }
        for (std::uint32_t k = 0; k < face.size; ++k) {
            const std::uint32_t a = face.corner[k], b = face.corner[(k + 1) % face.size];
            const auto [at, fresh] = edges.try_emplace({std::min(a, b), std::max(a, b)},
                                                       static_cast<std::uint32_t>(edges_.size()));
            if (fresh)
                edges_.push_back({{std::min(a, b), std::max(a, b)}});
            face.edge[k] = at->second;
        }
        faces_.push_back(face);
    }
    join_triangles();
}

// Two triangles of one plane that make a convex quadrilateral hide as one: half the work.
void SkyBlockers::join_triangles() {
    std::vector<std::vector<std::uint32_t>> faces_of(edges_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
        for (std::uint32_t k = 0; k < faces_[f].size; ++k)
            faces_of[faces_[f].edge[k]].push_back(f);
    std::vector<bool> gone(faces_.size(), false);
    for (std::uint32_t edge = 0; edge < edges_.size(); ++edge) {
        if (faces_of[edge].size() != 2)
            continue;
        const std::uint32_t a = faces_of[edge][0], b = faces_of[edge][1];
        if (!gone[a] && !gone[b] && join(faces_[a], faces_[b], edge))
            gone[b] = true;
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        if (!gone[f])
            faces_[kept++] = faces_[f];
    faces_.resize(kept);
}

bool SkyBlockers::join(Face& a, const Face& b, std::uint32_t edge) const {
    if (a.size != 3 || b.size != 3)
        return false;
    // The edge is that from corner i of a on; of b, against it.
    const std::uint32_t i = place_of(a.edge, edge), j = place_of(b.edge, edge);
    if (a.corner[i] != b.corner[(j + 1) % 3])
        return false;
    Face joined;
    joined.size = 4;
    joined.corner = {a.corner[i], b.corner[(j + 2) % 3], a.corner[(i + 1) % 3],
                     a.corner[(i + 2) % 3]};
    joined.edge = {b.edge[(j + 1) % 3], b.edge[(j + 2) % 3], a.edge[(i + 1) % 3],
                   a.edge[(i + 2) % 3]};
    glm::dvec3 first(0);
    for (std::uint32_t k = 0; k < 4; ++k) {
        const glm::dvec3 in = corners_[joined.corner[k]] - corners_[joined.corner[(k + 3) % 4]];
        const glm::dvec3 out = corners_[joined.corner[(k + 1) % 4]] - corners_[joined.corner[k]];
        const glm::dvec3 turn = glm::cross(in, out) / (glm::length(in) * glm::length(out));
        if (k == 0)
            first = glm::normalize(turn);
        // A corner that is nearly straight would make a side that is none.
        if (!(glm::dot(turn, first) > 1e-6) ||
            glm::length(turn - glm::dot(turn, first) * first) > 1e-12)
            return false;
    }
    a = joined;
    return true;
}

}  // namespace parallux
