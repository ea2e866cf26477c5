#include "throughput/embree_engine.h"

#include <algorithm>

#include "parallux/error.h"

namespace parallux::throughput {

namespace {

template <unsigned N>
void keep(const RTCFilterFunctionNArguments& arguments) {
    const Query& query = *reinterpret_cast<const Query*>(arguments.context);
    RTCRayN* ray = arguments.ray;
    RTCHitN* hit = arguments.hit;
    unsigned lanes = 0;
    for (unsigned i = 0; i < N; ++i)
        lanes |= static_cast<unsigned>(arguments.valid[i] == -1) << i;
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto i = static_cast<unsigned>(__builtin_ctz(lanes));
        arguments.valid[i] = 0;
        HitArray& array = query.lanes[RTCRayN_id(ray, N, i)];
        const std::uint32_t k = array.count++;
        if (k >= most_hits)
            continue;
        const float along = RTCHitN_Ng_x(hit, N, i) * RTCRayN_dir_x(ray, N, i) +
                            RTCHitN_Ng_y(hit, N, i) * RTCRayN_dir_y(ray, N, i) +
                            RTCHitN_Ng_z(hit, N, i) * RTCRayN_dir_z(ray, N, i);
        const std::uint32_t id =
            query.first_of[RTCHitN_geomID(hit, N, i)] + RTCHitN_primID(hit, N, i);
        array.hits[k] = {RTCRayN_tfar(ray, N, i), RTCHitN_u(hit, N, i), RTCHitN_v(hit, N, i),
                         id | (along > 0 ? RawHit::from_behind : 0)};
    }
}

bool nearer(const RawHit& a, const RawHit& b) {
    return a.t != b.t ? a.t < b.t : a.id < b.id;
}

}  // namespace

void keep_all(const RTCFilterFunctionNArguments* arguments) {
    // Packets come as 16, or one by one on processors that have no vectors of that length.
    if (arguments->N == 16)
        keep<16>(*arguments);
    else if (arguments->N == 8)
        keep<8>(*arguments);
    else if (arguments->N == 4)
        keep<4>(*arguments);
    else
        keep<1>(*arguments);
}

void append_sorted(const EmbreeScene& scene, HitArray& array, IntersectionLists& lists) {
    RawHit *begin = array.hits, *end = begin + array.count;
    if (array.count > most_hits)
        throw Error(Fault::internal,
                    "a line meets more surfaces than Embree's lists have room for");
    if (array.count > 24) {
        std::sort(begin, end, nearer);
    } else {
        for (RawHit* k = begin + 1; k < end; ++k) {
            const RawHit raw = *k;
            RawHit* place = k;
            for (; place > begin && nearer(raw, place[-1]); --place)
                *place = place[-1];
            *place = raw;
        }
    }
    for (const RawHit* raw = begin; raw < end; ++raw)
        lists.hits.push_back(scene.hit(*raw));
    lists.start.push_back(static_cast<std::uint32_t>(lists.hits.size()));
    array.count = 0;
}

Query EmbreeEngine::query(HitArray* lanes, RTCIntersectContextFlags coherence) const {
    Query query;
    rtcInitIntersectContext(&query.context);
    query.context.flags = coherence;
    if (choice_.context_filter)
        query.context.filter = keep_all;
    std::copy_n(scene_->first_of(), 2, query.first_of);
    query.lanes = lanes;
    return query;
}

void EmbreeEngine::choose(const std::vector<int>& columns, const std::function<Measured()>& trial) {
    bool kind[2] = {false, false};
    for (const Surface& surface : case_.scene.surfaces)
        kind[surface.shape() == Shape::parallelogram] = true;
    std::vector<bool> layouts{false};
    if (kind[0] && kind[1])
        layouts.push_back(true);
    EmbreeChoice best;
    std::shared_ptr<const EmbreeScene> best_scene;
    for (bool all_quads : layouts)
        for (bool context_filter : {false, true}) {
            choice_ = {context_filter, false, all_quads, 4};
            scene_ = std::make_shared<EmbreeScene>(case_, parts_, choice_, keep_all);
            for (bool occluded : {false, true})
                for (int width : columns) {
                    choice_.occluded = occluded;
                    choice_.columns = width;
                    double rate = 0;
                    for (int again = 0; again < (whole_ ? 1 : 5); ++again)
                        rate = std::max(rate, trial().lines_per_second());
                    if (rate > rate_) {
                        rate_ = rate;
                        best = choice_;
                        best_scene = scene_;
                    }
                }
        }
    choice_ = best;
    scene_ = best_scene;
}

std::string EmbreeEngine::choice() const {
    std::string text = choice_.context_filter ? "context filter" : "geometry filter";
    text += choice_.occluded ? ", any-hit query" : ", closest-hit query";
    if (choice_.all_quads)
        text += ", triangles as quads";
    return text;
}

}  // namespace parallux::throughput
