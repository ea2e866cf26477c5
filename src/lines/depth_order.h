#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "lines/edge_walk.h"
#include "parallux/lines.h"

namespace parallux {

/// Whether two surfaces share a corner.
inline bool touch(const Surface& a, const Surface& b) {
    for (std::uint32_t k : a.corner)
        for (std::uint32_t l : b.corner)
            if (k == l && k != none)
                return true;
    return false;
}

/// Planes closer than this, in radii, are meant to be one: what is left of coordinates in 24 bits.
inline constexpr double coordinate_rounding = 1e-6;

/// Surfaces without a common corner whose depths differ by less than this, in radii, lie in one
/// place: no more than their corners' snapping, at slopes to 16.
inline float same_place(const Projection& projection) {
    return static_cast<float>(16 * projection.bundle.spacing / projection.radius / fixed_one);
}

/// Depths closer than this, in radii, are near ties: what snapping makes of two slopes of 32.
/// Steeper surfaces bring their own slack.
inline float near_tie(double spacing, double radius) {
    return static_cast<float>(2 * 32 * spacing / radius / fixed_one);
}

/// How two surfaces lie to each other. The same for all bundles, so that what was found is kept.
///  apart     no corner in common, planes that cross
///  parallel  planes along each other; with a corner in common one plane
///  touching  a corner in common, planes that cross
class SurfaceRelations {
public:
    enum Relation : std::uint8_t { apart, parallel, touching };

    /// `radius` of the scene's sphere, metres; sheet_faces().
    SurfaceRelations(const Scene& scene, double radius, const std::vector<bool>& sheets)
        : scene_(scene), radius_(radius), sheets_(sheets) {}
    Relation of(std::uint32_t a, std::uint32_t b);
    bool is_sheet(std::uint32_t surface) const { return sheets_[surface]; }

private:
    struct Known {
        std::uint32_t a = none, b = none;
        Relation relation = apart;
    };
    Relation find(const Surface& a, const Surface& b) const;

    const Scene& scene_;
    double radius_;
    const std::vector<bool>& sheets_;
    std::vector<Known> known_ = std::vector<Known>(1 << 12);
};

/// The order of two hits of one line that rounding may have turned. Faces that share a corner by
/// the exact depth of their snapped corners, in which two faces meet along their common edge;
/// others by their own, unsnapped planes; and where those are one, so that the one met from behind
/// comes first (a solid that stands on a floor: the gap is between them) and the faces of sheets as
/// those of a solid (place_rank()). SharedPlaces has the same order for rays.
class TieOrder {
public:
    /// `slack[surface]` is how far snapping may have moved the depths of each.
    TieOrder(const Projection& projection, const Scene& scene, const Patches& patches,
             const glm::dvec3& centre, std::int32_t column, std::int32_t row,
             const std::vector<float>& slack, SurfaceRelations& relations)
        : projection_(projection),
          scene_(scene),
          patches_(patches),
          centre_(centre),
          column_(column),
          row_(row),
          slack_(slack),
          relations_(relations) {}

    bool before(const Hit& a, const Hit& b) const;

private:
    bool before_curved(const Hit& a, const Hit& b) const;
    bool from_behind(const Hit& hit) const;

    const Projection& projection_;
    const Scene& scene_;
    const Patches& patches_;
    const glm::dvec3& centre_;
    std::int32_t column_, row_;
    const std::vector<float>& slack_;
    SurfaceRelations& relations_;
};

/// Orders hits of one line again that lie closer together than the snapping could move them.
/// `begin` … `end` are sorted by depth, then surface.
void order_near_ties(const Projection& projection, const Scene& scene, const Patches& patches,
                     const glm::dvec3& centre, std::int32_t column, std::int32_t row,
                     const std::vector<float>& slack, SurfaceRelations& relations, Hit* begin,
                     Hit* end);

}  // namespace parallux
