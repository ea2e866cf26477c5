#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/scene.h"

namespace parallux {

/// Surfaces that lie in one plane and overlap there: panels against a wall, a box on a floor, a
/// sticker. Which of them a ray meets first must not be chance, and must be what a bundle's line
/// meets (TieOrder): by place_rank(), the one met from behind before others but for the faces of
/// sheets; else the nearer plane; else, with the first of the scene in front of others that look
/// the same way. A ray of the other direction meets them the other way round. Disks are among them;
/// other curved surfaces are not, nowhere but at points and edges in one place with others, but for
/// identical ones, which RayCurves has in the scene's order. Immutable.
class SharedPlaces {
public:
    /// O(n log n) for n surfaces of which few lie in one plane and over each other along its
    /// longest axis.
    explicit SharedPlaces(const Scene& scene);

    /// Those that share a part of a surface's place, in the scene's order. None for most.
    std::span<const std::uint32_t> with(std::uint32_t surface) const {
        if (begin_.empty() || surface == none)
            return {};
        return {others_.data() + begin_[surface], others_.data() + begin_[surface + 1]};
    }

    /// Whether a ray along `direction` meets a before b, of two that share a place.
    bool before(std::uint32_t a, std::uint32_t b, const glm::dvec3& direction) const;

    /// Whether a point of its plane lies on the surface, one of those that share a place; at (u,
    /// v).
    bool holds(std::uint32_t surface, const glm::dvec3& point, double& u, double& v) const;

    /// Whether a point lies in the plane of a surface that shares its place.
    bool in_plane(std::uint32_t surface, const glm::dvec3& point) const;

    /// Whether something lies in front of a part, a convex polygon, of a surface that a ray along
    /// `out` leaves.
    bool covers_part(std::uint32_t surface, const glm::dvec3& out,
                     std::span<const glm::dvec3> part) const;

    /// Whether the ray has met the surface from behind.
    bool from_behind(std::uint32_t surface, const glm::dvec3& direction) const;

private:
    struct Plane {
        glm::dvec3 origin, u, v, normal;
        double uu, uv, vv;
        Surface surface;
        bool sheet = false;         // one of its two faces
        std::optional<Curve> disk;  // the corners are those of the square about it
    };
    const Plane& plane(std::uint32_t surface) const { return planes_[plane_of_[surface]]; }

    std::vector<std::uint32_t> begin_, others_;  // rows of a sparse matrix; empty: none at all
    std::vector<std::uint32_t> plane_of_;
    std::vector<Plane> planes_;
    double radius_ = 0;
};

}  // namespace parallux
