#include "throughput/embree_lines.h"

#include <algorithm>
#include <cmath>

#include "lines/directions.h"
#include "lines/ray_scene.h"
#include "parallel.h"
#include "throughput/transfers.h"

namespace parallux::throughput {

namespace {

// A worker's own arrays, kept from piece to piece.
struct Buffers {
    std::unique_ptr<HitArray> array = std::make_unique<HitArray>();
    IntersectionLists lists;
};

constexpr std::size_t lines_a_piece = 1024;

}  // namespace

EmbreeLines::EmbreeLines(const Case& of, Parts parts, bool whole) : EmbreeEngine(of, parts, whole) {
    const std::uint64_t few = std::min<std::uint64_t>(all_lines(), 100'000);
    choose({1}, [&] { return trace(1, 0, few); });
}

std::uint64_t EmbreeLines::all_lines() const {
    return static_cast<std::uint64_t>(static_cast<double>(case_.bundles) * case_.lines_per_bundle);
}

Measured EmbreeLines::run(unsigned threads) {
    const auto enough = static_cast<std::uint64_t>(enough_lines(threads));
    return trace(threads, 0, whole_ ? all_lines() : std::min(all_lines(), enough));
}

void EmbreeLines::trace_piece(const LineSphere& sphere, std::uint64_t first, std::size_t count,
                              HitArray& array, IntersectionLists& lists) const {
    Query own = query(&array, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    lists.start.assign(1, 0);
    lists.hits.clear();
    const double half = 1.001 * sphere.radius;
    const glm::dvec3 middle = sphere.centre - scene_->centre();
    for (std::size_t k = 0; k < count; ++k) {
        Random random(1, stream::lines + first + k);
        const glm::dvec3 direction = uniform_direction(random);
        glm::dvec3 x, y;
        frame_across(direction, x, y);
        double square = 0;
        const glm::dvec2 place = sphere.radius * uniform_disk(random, square);
        const glm::dvec3 origin = middle + place.x * x + place.y * y - half * direction;
        RTCRayHit r;
        r.ray = {static_cast<float>(origin.x),
                 static_cast<float>(origin.y),
                 static_cast<float>(origin.z),
                 0,
                 static_cast<float>(direction.x),
                 static_cast<float>(direction.y),
                 static_cast<float>(direction.z),
                 0,
                 static_cast<float>(2 * half),
                 ~0u,
                 0,
                 0};
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        if (choice_.occluded)
            rtcOccluded1(scene_->handle(), &own.context, &r.ray);
        else
            rtcIntersect1(scene_->handle(), &own.context, &r);
        append_sorted(*scene_, array, lists);
    }
}

Measured EmbreeLines::trace(unsigned threads, std::uint64_t first, std::uint64_t count) const {
    Transfers transfers(case_, threads);
    std::vector<Buffers> buffers(transfers.plan().threads);
    const auto in_batch = static_cast<std::uint64_t>(16 * case_.lines_per_bundle);
    for (std::uint64_t done = 0; done < count; done += in_batch)
        transfers.batch([&] {
            parallel_for(threads, std::min(in_batch, count - done), lines_a_piece,
                         [&](std::size_t begin, std::size_t end, unsigned worker) {
                             const DenormalsOff guard;
                             Buffers& own = buffers[worker];
                             trace_piece(transfers.plan().sphere, first + done + begin, end - begin,
                                         *own.array, own.lists);
                             transfers.follow(own.lists, worker);
                         });
        });
    return transfers.result();
}

}  // namespace parallux::throughput
