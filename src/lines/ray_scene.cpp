#include "lines/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>
#include <glm/geometric.hpp>

#include "lines/ray_curves.h"
#include "lines/shared_places.h"
#include "parallel.h"
#include "parallux/error.h"

namespace parallux {

DenormalsOff::DenormalsOff() : saved_(_mm_getcsr()) {
    constexpr unsigned off = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON;
    // Setting the register costs as much as a short ray: not where it is set already.
    changed_ = (saved_ & off) != off;
    if (changed_)
        _mm_setcsr(saved_ | off);
}

DenormalsOff::~DenormalsOff() {
    if (changed_)
        _mm_setcsr(saved_);
}

namespace {

SurfaceHit to_hit(const RayQuery& query, unsigned geometry, unsigned primitive, float u, float v,
                  float t, float along_normal) {
    SurfaceHit hit;
    hit.surface = (*query.surface_of[geometry])[primitive];
    hit.u = u;
    hit.v = v;
    hit.t = t;
    hit.back = along_normal > 0;
    return hit;
}

// Leaves out the surfaces that the query skips, and gathers all others where a list is wanted.
void filter(const RTCFilterFunctionNArguments* arguments) {
    auto* query = reinterpret_cast<RayQuery*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] != -1)
            continue;
        unsigned geometry = RTCHitN_geomID(arguments->hit, arguments->N, i);
        unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, i);
        std::uint32_t surface = (*query->surface_of[geometry])[primitive];
        if (query->skips(surface)) {
            arguments->valid[i] = 0;
        } else if (query->hits) {
            unsigned n = arguments->N;
            float along = RTCHitN_Ng_x(arguments->hit, n, i) * RTCRayN_dir_x(arguments->ray, n, i) +
                          RTCHitN_Ng_y(arguments->hit, n, i) * RTCRayN_dir_y(arguments->ray, n, i) +
                          RTCHitN_Ng_z(arguments->hit, n, i) * RTCRayN_dir_z(arguments->ray, n, i);
            query->hits->push_back(
                to_hit(*query, geometry, primitive, RTCHitN_u(arguments->hit, n, i),
                       RTCHitN_v(arguments->hit, n, i), RTCRayN_tfar(arguments->ray, n, i), along));
            arguments->valid[i] = 0;
        }
    }
}

[[noreturn]] void fail(const std::string& what, RTCError error) {
    throw Error(error == RTC_ERROR_OUT_OF_MEMORY ? Fault::memory : Fault::internal,
                "Embree cannot " + what + " (error " + std::to_string(error) + ")");
}

}  // namespace

struct RayScene::Data {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    glm::dvec3 centre{0};
    SharedPlaces shared;
    std::vector<std::uint32_t> surface_of[2];  // geometry 0: triangles, 1: quads
    std::unique_ptr<RayCurves> curves;         // geometry 2; null: there are none

    explicit Data(const Scene& source) : shared(source) {}
    ~Data() {
        if (scene)
            rtcReleaseScene(scene);
        if (device)
            rtcReleaseDevice(device);
    }

    void add(const Scene& source, unsigned geometry_id) {
        std::vector<std::uint32_t>& members = surface_of[geometry_id];
        bool quads = geometry_id == 1;
        std::vector<unsigned> corners;
        for (std::uint32_t s = 0; s < source.surfaces.size(); ++s) {
            const Surface& surface = source.surfaces[s];
            if (surface.is_curved() || (surface.shape() == Shape::parallelogram) != quads)
                continue;
            members.push_back(s);
            corners.insert(corners.end(), surface.corner.begin(),
                           surface.corner.begin() + (quads ? 4 : 3));
        }
        if (members.empty())
            return;
        RTCGeometry geometry =
            rtcNewGeometry(device, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), source.positions.size()));
        auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
            (quads ? 4 : 3) * sizeof(unsigned), members.size()));
        if (!vertices || !indices)
            throw Error(Fault::memory, "no memory for the ray tracer's geometry");
        for (std::size_t p = 0; p < source.positions.size(); ++p)
            for (int axis = 0; axis < 3; ++axis)
                vertices[3 * p + axis] =
                    static_cast<float>(source.positions[p][axis] - centre[axis]);
        std::copy(corners.begin(), corners.end(), indices);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcSetGeometryIntersectFilterFunction(geometry, filter);
        rtcSetGeometryOccludedFilterFunction(geometry, filter);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, geometry_id);
        rtcReleaseGeometry(geometry);
    }

    RayQuery query(const glm::dvec3& origin, const glm::dvec3& direction) const {
        RayQuery q;
        q.origin = origin;
        q.direction = direction;
        rtcInitIntersectContext(&q.context);
        q.surface_of[0] = &surface_of[0];
        q.surface_of[1] = &surface_of[1];
        q.surface_of[2] = curves ? &curves->surfaces() : nullptr;
        return q;
    }

    bool is_curved(std::uint32_t surface) const { return curves && curves->holds(surface); }

    void add_curves(const Scene& source) {
        if (!has_curves(source))
            return;
        curves = std::make_unique<RayCurves>(source, centre);
        RTCGeometry geometry = curves->geometry(device);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, 2);
        rtcReleaseGeometry(geometry);
    }

    // What shares the place of a surface that a ray leaves or ends on; nothing where it begins or
    // ends beside the surface.
    std::span<const std::uint32_t> beside(std::uint32_t surface, const glm::dvec3& point) const {
        const std::span<const std::uint32_t> others = shared.with(surface);
        return others.empty() || shared.in_plane(surface, point) ? others
                                                                 : std::span<const std::uint32_t>();
    }

    // Of some surfaces of one place, the first that a ray along the direction meets at the point
    // after `from`, which it leaves; or, where it leaves none, the first of them and of what it has
    // met there, but for `skip`.
    SurfaceHit first_of(std::span<const std::uint32_t> others, const glm::dvec3& point,
                        const glm::dvec3& direction, std::uint32_t from, SurfaceHit met,
                        std::uint32_t skip = none) const {
        for (std::uint32_t other : others) {
            double u, v;
            if (other == skip)
                continue;
            if (from != none && shared.before(other, from, direction))
                continue;
            if (met.surface != none && !shared.before(other, met.surface, direction))
                continue;
            if (!shared.holds(other, point, u, v))
                continue;
            met.surface = other;
            met.u = static_cast<float>(u);
            met.v = static_cast<float>(v);
            met.back = shared.from_behind(other, direction);
        }
        return met;
    }

    RTCRay ray(const glm::dvec3& origin, const glm::dvec3& direction, double far) const {
        glm::dvec3 local = origin - centre;
        RTCRay r{};
        r.org_x = static_cast<float>(local.x);
        r.org_y = static_cast<float>(local.y);
        r.org_z = static_cast<float>(local.z);
        r.dir_x = static_cast<float>(direction.x);
        r.dir_y = static_cast<float>(direction.y);
        r.dir_z = static_cast<float>(direction.z);
        r.tnear = 0;
        r.tfar = static_cast<float>(std::min(far, double(std::numeric_limits<float>::max())));
        r.mask = ~0u;
        return r;
    }
};

RayScene::RayScene(const Scene& scene, unsigned threads) : data_(std::make_unique<Data>(scene)) {
    data_->device = rtcNewDevice(nullptr);
    if (!data_->device)
        fail("start on this machine", rtcGetDeviceError(nullptr));
    // The first question makes the place where this thread's errors are kept: a fresh device has no
    // other error than that there is no memory for it.
    if (rtcGetDeviceError(data_->device) != RTC_ERROR_NONE)
        fail("start on this machine", RTC_ERROR_OUT_OF_MEMORY);
    Bounds bounds = scene_bounds(scene);
    data_->centre = 0.5 * (bounds.low + bounds.high);
    data_->scene = rtcNewScene(data_->device);
    rtcSetSceneFlags(data_->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(data_->scene, RTC_BUILD_QUALITY_MEDIUM);
    data_->add(scene, 0);
    data_->add(scene, 1);
    data_->add_curves(scene);
    // Built inside an arena of so many threads; Embree's own setting would bind the whole process.
    unsigned workers = std::min(thread_count(threads), thread_count(0));
    tbb::task_arena arena(static_cast<int>(workers));
    arena.execute([&] { rtcCommitScene(data_->scene); });
    if (RTCError error = rtcGetDeviceError(data_->device); error != RTC_ERROR_NONE)
        fail("build the scene", error);
}

RayScene::~RayScene() = default;

SurfaceHit RayScene::closest(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                             std::uint32_t skip) const {
    const SharedPlaces& shared = data_->shared;
    const std::span<const std::uint32_t> beside = data_->beside(skip, origin);
    SurfaceHit hit = data_->first_of(beside, origin, direction, skip, {});
    if (hit.surface != none)
        return hit;
    DenormalsOff guard;
    RayQuery query = data_->query(origin, direction);
    query.skip_a = skip;
    query.with_a = beside;
    RTCRayHit r{};
    r.ray = data_->ray(origin, direction, far);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(data_->scene, &query.context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {};
    float along = r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z;
    hit = to_hit(query, r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar, along);
    const std::span<const std::uint32_t> others = shared.with(hit.surface);
    if (others.empty())
        return hit;
    return data_->first_of(others, origin + double(hit.t) * direction, direction, none, hit, skip);
}

bool RayScene::blocked(const glm::dvec3& a, const glm::dvec3& b, std::uint32_t skip_a,
                       std::uint32_t skip_b) const {
    const glm::dvec3 way = b - a;
    const std::span<const std::uint32_t> with_a = data_->beside(skip_a, a);
    const std::span<const std::uint32_t> with_b = data_->beside(skip_b, b);
    if (data_->first_of(with_a, a, way, skip_a, {}).surface != none)
        return true;
    // Seen from its end, the ray goes the other way.
    if (data_->first_of(with_b, b, -way, skip_b, {}).surface != none)
        return true;
    DenormalsOff guard;
    RayQuery query = data_->query(a, way);
    query.skip_a = skip_a;
    query.skip_b = skip_b;
    query.with_a = with_a;
    query.with_b = with_b;
    RTCRay r = data_->ray(a, way, 1);
    rtcOccluded1(data_->scene, &query.context, &r);
    return r.tfar < 0;
}

glm::dvec3 RayScene::on_line(std::uint32_t surface, bool back, const glm::dvec3& point,
                             const glm::dvec3& direction, double reach) const {
    if (!data_->is_curved(surface))
        return point;
    thread_local std::vector<SurfaceHit> hits;
    const glm::dvec3 from = point - reach * direction;
    all(from, direction, 2 * reach, hits);
    double nearest = HUGE_VAL, t = reach;
    for (const SurfaceHit& hit : hits)
        if (hit.surface == surface && hit.back == back &&
            std::fabs(hit.t - reach) < std::fabs(nearest - reach))
            t = nearest = hit.t;
    return from + t * direction;
}

bool RayScene::covered(std::uint32_t surface, const glm::dvec3& out,
                       const glm::dvec3& point) const {
    return data_->first_of(data_->shared.with(surface), point, out, surface, {}).surface != none;
}

bool RayScene::covered_in_part(std::uint32_t surface, const glm::dvec3& out,
                               std::span<const glm::dvec3> part) const {
    return data_->shared.covers_part(surface, out, part);
}

void RayScene::all(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                   std::vector<SurfaceHit>& hits) const {
    DenormalsOff guard;
    hits.clear();
    RayQuery query = data_->query(origin, direction);
    query.hits = &hits;
    RTCRayHit r{};
    r.ray = data_->ray(origin, direction, far);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(data_->scene, &query.context, &r);
    if (hits.size() < 2)
        return;
    std::sort(hits.begin(), hits.end(), [](const SurfaceHit& a, const SurfaceHit& b) {
        return a.t != b.t ? a.t < b.t : a.surface < b.surface;
    });
    // A flat surface is met once: a second time is its other half, which others may come before. A
    // curved one is met as often as it likes.
    auto kept = hits.begin();
    for (const SurfaceHit& hit : hits)
        if (data_->is_curved(hit.surface) ||
            std::none_of(hits.begin(), kept,
                         [&](const SurfaceHit& k) { return k.surface == hit.surface; }))
            *kept++ = hit;
    hits.erase(kept, hits.end());
    // Those in one place by their order; anything else between them stays where it is.
    for (std::size_t k = 1; k < hits.size(); ++k)
        for (std::size_t at = k; at > 0; --at) {
            const auto others = data_->shared.with(hits[at].surface);
            if (std::find(others.begin(), others.end(), hits[at - 1].surface) == others.end() ||
                !data_->shared.before(hits[at].surface, hits[at - 1].surface, direction))
                break;
            std::swap(hits[at - 1], hits[at]);
            std::swap(hits[at - 1].t, hits[at].t);
        }
}

}  // namespace parallux
