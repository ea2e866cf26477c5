#include "output/neighbours.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "output/point_tree.h"
#include "parallel.h"

namespace parallux {

namespace {

constexpr double crease = 0.35;          // radians between two faces of one smooth surface
constexpr double one_side = 0.55;        // radians between normals of patches that are mixed
constexpr double one_curved_side = 1.2;  // of cells of one curved surface, smooth however coarse

// Surfaces joined over welded edges without a crease, by a representative of each set.
class SmoothSurfaces {
public:
    explicit SmoothSurfaces(const Scene& scene) : parent_(scene.surfaces.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        // Bring equal edges together.
        struct Edge {
            std::uint64_t key;
            std::uint32_t surface;
        };
        std::vector<Edge> edges;
        std::vector<glm::dvec3> normal(scene.surfaces.size());
        edges.reserve(3 * scene.surfaces.size());
        // Curved surfaces of one material are one smooth surface; where their normals differ they
        // are parted pair by pair.
        std::vector<std::uint32_t> curved(scene.materials.size(), none);
        for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
            const Surface& surface = scene.surfaces[s];
            if (surface.is_curved()) {
                std::uint32_t& other = curved[surface.material];
                if (other != none)
                    parent_[root(s)] = root(other);
                other = s;
            }
            normal[s] = surface_normal(scene, surface);
            std::uint32_t corners = surface.shape() == Shape::triangle ? 3 : 4;
            for (std::uint32_t k = 0; k < corners; ++k) {
                auto [low, high] =
                    std::minmax(surface.corner[k], surface.corner[(k + 1) % corners]);
                edges.push_back({std::uint64_t(low) << 32 | high, s});
            }
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return a.key != b.key ? a.key < b.key : a.surface < b.surface;
        });
        // Join the surfaces of each edge that meet smoothly, whichever way they are turned.
        for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
            for (end = begin; end < edges.size() && edges[end].key == edges[begin].key;)
                ++end;
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t j = i + 1; j < std::min(end, i + 8); ++j) {
                    std::uint32_t a = edges[i].surface, b = edges[j].surface;
                    if (std::abs(glm::dot(normal[a], normal[b])) > std::cos(crease))
                        parent_[root(a)] = root(b);
                }
        }
        for (std::uint32_t s = 0; s < parent_.size(); ++s)
            parent_[s] = root(s);
    }

    std::uint32_t of(std::uint32_t surface) const { return parent_[surface]; }

private:
    std::uint32_t root(std::uint32_t s) {
        while (parent_[s] != s)
            s = parent_[s] = parent_[parent_[s]];
        return s;
    }

    std::vector<std::uint32_t> parent_;
};

double reach(const ExposedPatch& patch) {
    return patch.extent + reach_in_sides * patch.size;
}

// The tests of a pair; all are symmetric.
class PairTest {
public:
    PairTest(const Scene& scene, const RayScene& rays) : smooth_(scene), rays_(rays) {
        Bounds bounds = scene_bounds(scene);
        rounding_ = 4e-6 * glm::length(bounds.high - bounds.low);
        for (const Surface& surface : scene.surfaces)
            curved_.push_back(surface.is_curved());
    }

    bool operator()(const ExposedPatch& a, const ExposedPatch& b) const {
        double turn = glm::dot(a.normal, b.normal);
        const bool one_curve = a.surface == b.surface && curved_[a.surface];
        if (turn < std::cos(one_curve ? one_curved_side : one_side))
            return false;
        glm::dvec3 way = b.mean - a.mean;
        double distance = glm::length(way);
        double size = std::max(a.size, b.size);
        bool coplanar =
            turn > 1 - 1e-6 && std::abs(glm::dot(a.normal, way)) <= 1e-4 * size + rounding_;
        if (!coplanar && !one_curve) {
            if (smooth_.of(a.surface) != smooth_.of(b.surface))
                return false;
            // Steps of one surface, one above the other, are not one piece.
            glm::dvec3 between = glm::normalize(a.normal + b.normal);
            if (std::abs(glm::dot(between, way)) > 0.35 * distance)
                return false;
        }
        return !separated(a, b, turn, distance, size);
    }

private:
    // Looks from one to the other a little above the surface, higher where it bulges between them.
    // A cluster may be rough, so a second look must pass over its bumps; what merely hangs before
    // it is in the way of that one alone.
    bool separated(const ExposedPatch& a, const ExposedPatch& b, double turn, double distance,
                   double size) const {
        double bulge = 0.25 * distance * std::acos(std::min(turn, 1.0));
        double lift = rounding_ + 0.02 * size + bulge;
        if (!blocked(a, b, lift))
            return false;
        return !(a.cluster || b.cluster) || blocked(a, b, lift + 0.1 * size);
    }

    bool blocked(const ExposedPatch& a, const ExposedPatch& b, double lift) const {
        return rays_.blocked(a.seen + lift * a.normal, b.seen + lift * b.normal, a.surface,
                             b.surface);
    }

    SmoothSurfaces smooth_;
    const RayScene& rays_;
    double rounding_;
    std::vector<bool> curved_;  // surfaces
};

}  // namespace

Neighbours::Neighbours(const Scene& scene, const std::vector<ExposedPatch>& patches,
                       const RayScene& rays, unsigned threads) {
    // Put the exposed patches into a tree by place and reach.
    std::vector<TreePoint> points;
    points.reserve(patches.size());
    for (std::uint32_t p = 0; p < patches.size(); ++p)
        if (patches[p].share > 0)
            points.push_back({patches[p].mean, reach(patches[p]), p});
    PointTree tree(std::move(points));
    // Test each pair once, from its lower patch.
    PairTest test(scene, rays);
    std::vector<std::vector<std::uint32_t>> higher(patches.size());
    parallel_for(threads, patches.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t p = begin; p < end; ++p) {
            if (!(patches[p].share > 0))
                continue;
            tree.visit(patches[p].mean, reach(patches[p]), [&](std::uint32_t q) {
                if (q > p && test(patches[p], patches[q]))
                    higher[p].push_back(q);
            });
            std::sort(higher[p].begin(), higher[p].end());
        }
    });
    // Write both directions; ascending because the lower patches come in order.
    begin_.assign(patches.size() + 1, 0);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        begin_[p + 1] += higher[p].size();
        for (std::uint32_t q : higher[p])
            ++begin_[q + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    list_.resize(begin_.back());
    std::vector<std::uint64_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t p = 0; p < patches.size(); ++p)
        for (std::uint32_t q : higher[p])
            list_[next[q]++] = p;
    for (std::uint32_t p = 0; p < patches.size(); ++p)
        for (std::uint32_t q : higher[p])
            list_[next[p]++] = q;
}

bool Neighbours::joined(std::uint32_t a, std::uint32_t b) const {
    std::span<const std::uint32_t> list = of(a);
    return std::binary_search(list.begin(), list.end(), b);
}

}  // namespace parallux
