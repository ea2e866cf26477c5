#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "factors/visible.h"
#include "lines/ray_scene.h"
#include "random.h"
#include "solve/emitters.h"
#include "solve/sources.h"

// How much of a source a cell sees, past what stands between.

namespace parallux {

/// A surface or its back as a polygon.
Polygon whole_polygon(const Scene& scene, std::uint32_t surface, bool back);

/// Exchange area of a cell and a source with nothing between, m²: exact where they are near each
/// other, else by a rule of the cell's points to some 1e-5 of it.
double exchange_nearly(const Polygon& cell, const Polygon& source);

/// Points' views of sources in scenes of few surfaces, in closed form. One a thread.
class PointViews {
public:
    PointViews(const Scene& scene, const RayScene& rays, const std::vector<Polygon>& surfaces)
        : scene_(scene), rays_(rays), surfaces_(surfaces) {}

    /// Surfaces that may hide `to` from `from`, without these two. What turns its back on `from`
    /// is among them: it hides what is outside from patches within a solid.
    std::vector<std::uint32_t> between(const Polygon& from, const Polygon& to, std::uint32_t own,
                                       std::uint32_t source) const;

    /// The mean, over 2 k² points of a cell, of the form factor to what is seen of `to`: a grid of
    /// k × k, each with a point at one random place, and that opposite.
    double mean(const Emitter& cell, const Polygon& to, std::span<const std::uint32_t> blockers,
                std::uint32_t k, Random& random);

    /// The grid that a cell needs: the finer, the more five points of it differ.
    std::uint32_t grid_for(const Emitter& cell, const Polygon& to,
                           std::span<const std::uint32_t> blockers);

private:
    void hide(std::span<const std::uint32_t> blockers);

    // Of a cell's point, as it sees `to`; 0 where another surface lies on it.
    double seen_from(const Emitter& cell, const glm::dvec3& normal, double a, double b,
                     const Polygon& to);

    const Scene& scene_;
    const RayScene& rays_;
    const std::vector<Polygon>& surfaces_;
    std::vector<Polygon> blockers_;
    VisibleScratch scratch_;
};

/// Which share of what one polygon sends the other arrives: `count` pairs of even points with a
/// random start, weighted by the kernel cos θ cos θ' / r², a shadow ray each. A ratio of two means,
/// and so off by some 1 / count of its own error.
double visible_share(const Scene& scene, const RayScene& rays, const Source& source,
                     const Emitter& cell, std::uint32_t count, Random& random);

/// As many rays as a pair needs: few where 32 agree.
std::uint32_t rays_for(const Scene& scene, const RayScene& rays, const Source& source,
                       const Emitter& cell);

}  // namespace parallux
