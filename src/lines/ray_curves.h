#pragma once

#include <cstdint>
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
    std::uint32_t skip_a = none, skip_b = none;
    /// A curved surface may see itself: of one that is skipped, only what lies so near to the ray's
    /// beginning or end, in t, is left out.
    float near = 0;
    std::vector<SurfaceHit>* hits = nullptr;
};

/// The curved surfaces of a scene for Embree: whole ones where lines meet them in closed form,
/// others in pieces of a quarter radian, in which Newton's method finds what lines meet.
class RayCurves {
public:
    RayCurves(const Scene& scene, const glm::dvec3& centre);

    bool empty() const { return pieces_.empty(); }
    /// The geometry, whose user data this is; not to be moved.
    RTCGeometry geometry(RTCDevice device);
    /// Surface of each primitive.
    const std::vector<std::uint32_t>& surfaces() const { return surfaces_; }

private:
    struct Piece {
        std::uint32_t curve;
        double u0, u1, v0, v1;
    };
    static void bounds(const RTCBoundsFunctionArguments* arguments);
    static void intersect(const RTCIntersectFunctionNArguments* arguments);
    static void occluded(const RTCOccludedFunctionNArguments* arguments);
    /// Calls visit(t, u, v) for all crossings.
    template <class Visit>
    void meet(std::uint32_t piece, const RTCRay& ray, Visit&& visit) const;

    glm::dvec3 centre_;
    std::vector<Curve> curves_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> surfaces_;
};

}  // namespace parallux
