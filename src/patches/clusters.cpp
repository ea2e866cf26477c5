#include "patches/clusters.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {

namespace {

// Neighbours across edges, for the small surfaces only: compressed rows.
struct Adjacency {
    std::vector<std::uint32_t> start, neighbour;
};

Adjacency small_neighbours(const Scene& scene, const std::vector<bool>& small) {
    struct EdgeUse {
        std::uint64_t edge;
        std::uint32_t surface;
    };
    std::vector<EdgeUse> uses;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        if (!small[s])
            continue;
        const Surface& surface = scene.surfaces[s];
        unsigned corners = surface.shape() == Shape::triangle ? 3 : 4;
        for (unsigned k = 0; k < corners; ++k) {
            std::uint64_t a = surface.corner[k], b = surface.corner[(k + 1) % corners];
            uses.push_back({std::min(a, b) << 32 | std::max(a, b), s});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.surface < b.surface;
    });

    // Every pair that shares an edge and a material, both ways. An edge of very many faces is no
    // manifold and would make this quadratic: its faces are joined to the next one only.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::size_t k = 1; k < uses.size(); ++k) {
        if (uses[k].edge != uses[k - 1].edge)
            continue;
        std::uint32_t a = uses[k - 1].surface, b = uses[k].surface;
        if (a != b && scene.surfaces[a].material == scene.surfaces[b].material) {
            pairs.emplace_back(a, b);
            pairs.emplace_back(b, a);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    Adjacency adjacency;
    adjacency.start.assign(scene.surfaces.size() + 1, 0);
    adjacency.neighbour.reserve(pairs.size());
    for (const auto& [a, b] : pairs) {
        ++adjacency.start[a + 1];
        adjacency.neighbour.push_back(b);
    }
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        adjacency.start[s + 1] += adjacency.start[s];
    return adjacency;
}

glm::dvec3 middle(const Scene& scene, const Surface& surface) {
    double at = surface.shape() == Shape::triangle ? 1.0 / 3 : 0.5;
    return surface_point(scene, surface, at, at);
}

// Growing clusters one after another, each breadth first from the lowest surface left.
struct Growth {
    const Scene& scene;
    const std::vector<double>& areas;
    const Adjacency& adjacency;
    double size, smallest_cosine;
    std::vector<std::uint32_t>& cluster_of;
    std::vector<std::uint32_t> front = {};

    double grow(std::uint32_t seed, std::uint32_t cluster) {
        glm::dvec3 normal = surface_normal(scene, scene.surfaces[seed]);
        glm::dvec3 centre = middle(scene, scene.surfaces[seed]);
        double area = 0;
        front.assign(1, seed);
        cluster_of[seed] = cluster;
        for (std::size_t k = 0; k < front.size(); ++k) {
            std::uint32_t s = front[k];
            area += areas[s];
            for (std::uint32_t n = adjacency.start[s]; n < adjacency.start[s + 1]; ++n) {
                std::uint32_t next = adjacency.neighbour[n];
                if (cluster_of[next] != none || area >= size * size)
                    continue;
                const Surface& surface = scene.surfaces[next];
                if (glm::dot(normal, surface_normal(scene, surface)) < smallest_cosine ||
                    glm::distance(centre, middle(scene, surface)) > size)
                    continue;
                cluster_of[next] = cluster;
                front.push_back(next);
            }
        }
        return area;
    }
};

}  // namespace

std::uint32_t grow_clusters(const Scene& scene, const std::vector<double>& surface_areas,
                            double size, double crease, std::vector<std::uint32_t>& cluster_of) {
    std::vector<bool> small(scene.surfaces.size());
    for (std::size_t s = 0; s < small.size(); ++s)
        small[s] = !scene.surfaces[s].is_curved() && surface_areas[s] < 0.5 * size * size;
    Adjacency adjacency = small_neighbours(scene, small);
    cluster_of.assign(scene.surfaces.size(), none);
    Growth growth{scene, surface_areas, adjacency, size, std::cos(crease), cluster_of};
    std::vector<double> area;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (small[s] && cluster_of[s] == none)
            area.push_back(growth.grow(s, static_cast<std::uint32_t>(area.size())));

    // Scraps left between grown clusters would be met by few lines: each joins the smallest
    // neighbouring cluster that its normal allows.
    double scrap = 0.3 * size * size;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        std::uint32_t own = cluster_of[s];
        if (own == none || area[own] >= scrap)
            continue;
        glm::dvec3 normal = surface_normal(scene, scene.surfaces[s]);
        std::uint32_t best = none;
        for (std::uint32_t n = adjacency.start[s]; n < adjacency.start[s + 1]; ++n) {
            std::uint32_t next = adjacency.neighbour[n], cluster = cluster_of[next];
            if (cluster == own || area[cluster] < scrap ||
                glm::dot(normal, surface_normal(scene, scene.surfaces[next])) <
                    growth.smallest_cosine)
                continue;
            if (best == none || area[cluster] < area[best])
                best = cluster;
        }
        if (best != none) {
            area[best] += surface_areas[s];
            area[own] -= surface_areas[s];
            cluster_of[s] = best;
        }
    }

    // Number those in use without gaps, by first surface.
    std::vector<std::uint32_t> renumbered(area.size(), none);
    std::uint32_t count = 0;
    for (std::uint32_t& cluster : cluster_of)
        if (cluster != none) {
            if (renumbered[cluster] == none)
                renumbered[cluster] = count++;
            cluster = renumbered[cluster];
        }
    return count;
}

}  // namespace parallux
