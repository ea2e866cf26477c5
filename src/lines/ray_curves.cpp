#include "lines/ray_curves.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "surfaces/curve.h"

namespace parallux {

namespace {

// Chords of a quarter radian of a circle leave it by a thirty-second of their length.
constexpr double piece_bend = 1.0 / 32;

RTCRay ray_of(const RTCRayN* rays, unsigned count, unsigned k) {
    return rtcGetRayFromRayN(const_cast<RTCRayN*>(rays), count, k);
}

// `near`: in t.
bool skipped(const RayQuery& query, std::uint32_t surface, double t, double near) {
    return (surface == query.skip_a && t < near) || (surface == query.skip_b && t > 1 - near);
}

}  // namespace

RayCurves::RayCurves(const Scene& scene, const glm::dvec3& centre)
    : centre_(centre), curves_(scene.curves) {
    const Bounds all = scene_bounds(scene);
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const std::uint32_t number = scene.surfaces[s].curve;
        if (number == none)
            continue;
        const Curve& curve = curves_[number];
        const Bounds box = curve_bounds(curve, 0, 1, 0, 1, 4);
        const double near = std::max(1e-6 * glm::length(box.high - box.low),
                                     1e-9 * glm::length(all.high - all.low));
        std::vector<double> u{0, 1}, v{0, 1};
        if (!is_quadric(curve)) {
            u = curve_cuts(curve, true, 2, HUGE_VAL, piece_bend);
            v = curve_cuts(curve, false, 2, HUGE_VAL, piece_bend);
        }
        for (std::size_t j = 0; j + 1 < v.size(); ++j)
            for (std::size_t i = 0; i + 1 < u.size(); ++i) {
                pieces_.push_back({number, u[i], u[i + 1], v[j], v[j + 1], near});
                surfaces_.push_back(s);
            }
    }
}

RTCGeometry RayCurves::geometry(RTCDevice device) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(pieces_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    return geometry;
}

void RayCurves::bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& own = *static_cast<const RayCurves*>(arguments->geometryUserPtr);
    const Piece& piece = own.pieces_[arguments->primID];
    const Curve& curve = own.curves_[piece.curve];
    const Bounds box =
        curve_bounds(curve, piece.u0, piece.u1, piece.v0, piece.v1, is_quadric(curve) ? 32 : 6);
    // Room for what rays lose as floats.
    const double room =
        1e-5 * (glm::length(box.high - box.low) + glm::length(box.high - own.centre_));
    const glm::vec3 low(box.low - own.centre_ - room), high(box.high - own.centre_ + room);
    *arguments->bounds_o = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
}

template <class Visit>
void RayCurves::meet(std::uint32_t number, const RayQuery& query, Visit&& visit) const {
    const Piece& piece = pieces_[number];
    const Curve& curve = curves_[piece.curve];
    CurveRoot roots[4];
    const int count = is_quadric(curve)
                          ? quadric_roots(curve, query.origin, query.direction, roots)
                          : newton_roots(curve, query.origin, query.direction, piece.u0, piece.u1,
                                         piece.v0, piece.v1, roots);
    const double near = piece.near / glm::length(query.direction);
    for (int k = 0; k < count; ++k)
        if (!skipped(query, surfaces_[number], roots[k].t, near))
            visit(curve, roots[k]);
}

void RayCurves::intersect(const RTCIntersectFunctionNArguments* arguments) {
    const auto& own = *static_cast<const RayCurves*>(arguments->geometryUserPtr);
    auto& query = *reinterpret_cast<RayQuery*>(arguments->context);
    const std::uint32_t surface = own.surfaces_[arguments->primID];
    const unsigned n = arguments->N;
    for (unsigned k = 0; k < n; ++k) {
        if (arguments->valid[k] != -1)
            continue;
        RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
        RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, n);
        const RTCRay ray = ray_of(rays, n, k);
        float far = ray.tfar;
        std::uint32_t met = RTCHitN_geomID(hits, n, k) == arguments->geomID
                                ? own.surfaces_[RTCHitN_primID(hits, n, k)]
                                : none;
        own.meet(arguments->primID, query, [&](const Curve& curve, const CurveRoot& root) {
            const auto t = static_cast<float>(root.t);
            const bool first = t == far && met != none && surface < met;
            if (!(t > ray.tnear && (t < far || first)))
                return;
            const glm::vec3 normal(curve_normal(curve, root.u, root.v));
            const auto u = static_cast<float>(root.u), v = static_cast<float>(root.v);
            if (query.hits) {
                const float along =
                    normal.x * ray.dir_x + normal.y * ray.dir_y + normal.z * ray.dir_z;
                query.hits->push_back({surface, u, v, t, along > 0});
                return;
            }
            far = t;
            met = surface;
            RTCRayN_tfar(rays, n, k) = t;
            RTCHitN_u(hits, n, k) = u;
            RTCHitN_v(hits, n, k) = v;
            RTCHitN_Ng_x(hits, n, k) = normal.x;
            RTCHitN_Ng_y(hits, n, k) = normal.y;
            RTCHitN_Ng_z(hits, n, k) = normal.z;
            RTCHitN_primID(hits, n, k) = arguments->primID;
            RTCHitN_geomID(hits, n, k) = arguments->geomID;
            RTCHitN_instID(hits, n, k, 0) = arguments->context->instID[0];
        });
    }
}

void RayCurves::occluded(const RTCOccludedFunctionNArguments* arguments) {
    const auto& own = *static_cast<const RayCurves*>(arguments->geometryUserPtr);
    const auto& query = *reinterpret_cast<const RayQuery*>(arguments->context);
    for (unsigned k = 0; k < arguments->N; ++k) {
        if (arguments->valid[k] != -1)
            continue;
        const RTCRay ray = ray_of(arguments->ray, arguments->N, k);
        bool met = false;
        own.meet(arguments->primID, query, [&](const Curve&, const CurveRoot& root) {
            const auto t = static_cast<float>(root.t);
            met = met || (t > ray.tnear && t < ray.tfar);
        });
        if (met)
            RTCRayN_tfar(arguments->ray, arguments->N, k) = -HUGE_VALF;
    }
}

}  // namespace parallux
