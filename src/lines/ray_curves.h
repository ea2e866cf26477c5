#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

#include "lines/ray_scene.h"
#include "parallux/scene.h"

namespace parallux {

/// A query's own data behind Embree's context.
struct RayQuery {
    RTCIntersectContext context;
    const std::vector<std::uint32_t>* surface_of[3];
    /// As they were asked for: of floats a ray that grazes a curved surface from a point of it
    /// would meet it again beside that point.
    glm::dvec3 origin, direction;
    std::uint32_t skip_a = none, skip_b = none;
    std::span<const std::uint32_t> with_a, with_b;  ///< what shares their places is left out too
    std::vector<SurfaceHit>* hits = nullptr;

    bool skips(std::uint32_t surface) const {
        return surface == skip_a || surface == skip_b ||
               std::find(with_a.begin(), with_a.end(), surface) != with_a.end() ||
               std::find(with_b.begin(), with_b.end(), surface) != with_b.end();
    }
};

/// The curved surfaces of a scene for Embree: whole ones where lines meet them in closed form,
/// others in pieces of a quarter radian, in which Newton's method finds what lines meet. A curved
/// surface may see itself: of one that a ray leaves, or ends on, only that very place is left out,
/// which must be a point of it to a double's digits. Two identical ones in one place are met in the
/// scene's order.
class RayCurves {
public:
    RayCurves(const Scene& scene, const glm::dvec3& centre);

    bool holds(std::uint32_t surface) const {
        return std::binary_search(surfaces_.begin(), surfaces_.end(), surface);
    }
    /// The geometry, whose user data this is; not to be moved.
    RTCGeometry geometry(RTCDevice device);
    /// Surface of each primitive.
    const std::vector<std::uint32_t>& surfaces() const { return surfaces_; }

private:
    struct Piece {
        std::uint32_t curve;
        double u0, u1, v0, v1;
        double near;  ///< metres within which it does not see itself
    };
    static void bounds(const RTCBoundsFunctionArguments* arguments);
    static void intersect(const RTCIntersectFunctionNArguments* arguments);
    static void occluded(const RTCOccludedFunctionNArguments* arguments);
    /// Calls visit(curve, root) for all crossings but those that the query leaves out.
    template <class Visit>
    void meet(std::uint32_t piece, const RayQuery& query, Visit&& visit) const;

    glm::dvec3 centre_;
    std::vector<Curve> curves_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> surfaces_;
};

}  // namespace parallux
