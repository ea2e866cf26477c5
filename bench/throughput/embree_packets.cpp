#include "throughput/embree_packets.h"

#include <algorithm>
#include <cmath>

#include "lines/ray_scene.h"
#include "parallel.h"
#include "random.h"
#include "throughput/transfers.h"

namespace parallux::throughput {

namespace {
// Bundles that are ever traced in part: many directions. And at all: more than take a second.
constexpr std::size_t enough_bundles = 64, most_bundles = 2048;
}  // namespace

struct alignas(64) EmbreePackets::Lanes {
    RTCRayHit16 packet{};
    alignas(64) int valid[16];
    std::vector<HitArray> arrays{16};
};

// A bundle as Embree sees it: the line of column 0 and row 0 of its rectangle begins at `origin`.
namespace {
constexpr std::int32_t tile_side = 64;  // lines that one worker traces at a time
}

struct EmbreePackets::View {
    glm::vec3 origin, x, y, direction;
    float length;
    std::int32_t columns, rows, tiles_x;

    View(const Bundle& bundle, const LineRectangle& lines, const LineSphere& sphere,
         const glm::dvec3& centre)
        : x(bundle.spacing * bundle.x),
          y(bundle.spacing * bundle.y),
          direction(bundle.direction),
          length(static_cast<float>(2.002 * sphere.radius)),
          columns(lines.columns),
          rows(lines.rows),
          tiles_x((lines.columns + tile_side - 1) / tile_side) {
        origin = sphere.centre - centre - 1.001 * sphere.radius * bundle.direction +
                 bundle.spacing * ((lines.left - bundle.offset_x) * bundle.x +
                                   (lines.top - bundle.offset_y) * bundle.y);
    }

    std::size_t tiles() const {
        return static_cast<std::size_t>(tiles_x) * ((rows + tile_side - 1) / tile_side);
    }
};

EmbreePackets::EmbreePackets(const Case& of, bool whole) : EmbreeEngine(of, Parts::parents, whole) {
    const LineSphere sphere = line_sphere(of.scene);
    const std::uint64_t count = whole ? of.bundles : std::min(of.bundles, most_bundles);
    for (std::uint64_t k = 0; k < count; ++k) {
        bundles_.push_back(
            make_bundle({1, of.bundles, DirectionSet::lattice, of.spacing, true}, k));
        rectangles_.push_back(rectangle_of(of.scene, sphere.centre, bundles_.back()));
    }
    choose({4, 16}, [&] { return trace(1, 400'000); });
}

std::string EmbreePackets::choice() const {
    return EmbreeEngine::choice() + (choice_.columns == 4 ? ", 4 x 4 lines" : ", 16 x 1 lines");
}

Measured EmbreePackets::run(unsigned threads) {
    return trace(threads, whole_ ? INFINITY : enough_lines(threads));
}

void EmbreePackets::trace_tile(const View& view, std::size_t tile, Lanes& lanes,
                               IntersectionLists& lists) const {
    Query own = query(lanes.arrays.data(), RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    const int width = choice_.columns, height = 16 / width;
    const std::int32_t left = static_cast<std::int32_t>(tile % view.tiles_x) * tile_side;
    const std::int32_t top = static_cast<std::int32_t>(tile / view.tiles_x) * tile_side;
    const std::int32_t right = std::min(left + tile_side, view.columns);
    const std::int32_t bottom = std::min(top + tile_side, view.rows);
    lists.start.assign(1, 0);
    lists.hits.clear();
    RTCRay16& ray = lanes.packet.ray;
    for (std::int32_t row = top; row < bottom; row += height)
        for (std::int32_t column = left; column < right; column += width) {
            for (int i = 0; i < 16; ++i) {
                const std::int32_t c = column + i % width, r = row + i / width;
                const auto fc = static_cast<float>(c), fr = static_cast<float>(r);
                lanes.valid[i] = c < right && r < bottom ? -1 : 0;
                ray.org_x[i] = view.origin.x + fc * view.x.x + fr * view.y.x;
                ray.org_y[i] = view.origin.y + fc * view.x.y + fr * view.y.y;
                ray.org_z[i] = view.origin.z + fc * view.x.z + fr * view.y.z;
                ray.dir_x[i] = view.direction.x;
                ray.dir_y[i] = view.direction.y;
                ray.dir_z[i] = view.direction.z;
                ray.tnear[i] = 0;
                ray.time[i] = 0;
                ray.tfar[i] = view.length;
                ray.mask[i] = ~0u;
                ray.id[i] = static_cast<unsigned>(i);
                ray.flags[i] = 0;
                lanes.packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            }
            if (choice_.occluded)
                rtcOccluded16(lanes.valid, scene_->handle(), &own.context, &ray);
            else
                rtcIntersect16(lanes.valid, scene_->handle(), &own.context, &lanes.packet);
            for (int i = 0; i < 16; ++i)
                if (lanes.valid[i])
                    append_sorted(*scene_, lanes.arrays[static_cast<std::size_t>(i)], lists);
        }
}

std::vector<EmbreePackets::Tile> EmbreePackets::choose_tiles(const std::vector<View>& views,
                                                             std::size_t first, double share) {
    // Runs of neighbours, which find one another's surfaces still in the cache; every so many runs
    // one, since some parts of a bundle hold more than others.
    constexpr std::size_t run = 8;
    const auto period = static_cast<std::size_t>(std::round(1 / share));
    std::vector<Tile> chosen;
    for (std::size_t k = 0; k < views.size(); ++k)
        for (std::size_t tile = 0; tile < views[k].tiles(); ++tile)
            if ((tile / run + mix64(first + k)) % period == 0)
                chosen.push_back({k, tile});
    return chosen;
}

Measured EmbreePackets::trace(unsigned threads, double lines) const {
    const double wanted =
        std::max(std::ceil(lines / case_.lines_per_bundle), static_cast<double>(enough_bundles));
    const auto count =
        static_cast<std::size_t>(std::min(wanted, static_cast<double>(bundles_.size())));
    const double share =
        std::min(1.0, lines / (static_cast<double>(count) * case_.lines_per_bundle));
    Transfers transfers(case_, threads);
    std::vector<Lanes> lanes(transfers.plan().threads);
    std::vector<IntersectionLists> lists(transfers.plan().threads);
    for (std::size_t done = 0; done < count; done += 16)
        transfers.batch([&] {
            // All tiles of the batch, so that workers share them as the bundle engine's do.
            std::vector<View> views;
            for (std::size_t k = done; k < std::min(done + 16, count); ++k)
                views.emplace_back(bundles_[k], rectangles_[k], transfers.plan().sphere,
                                   scene_->centre());
            const std::vector<Tile> tiles = choose_tiles(views, done, share);
            parallel_for(threads, tiles.size(), 4,
                         [&](std::size_t begin, std::size_t end, unsigned worker) {
                             const DenormalsOff guard;
                             for (std::size_t k = begin; k < end; ++k) {
                                 trace_tile(views[tiles[k].view], tiles[k].tile, lanes[worker],
                                            lists[worker]);
                                 transfers.follow(lists[worker], worker);
                             }
                         });
        });
    return transfers.result();
}

}  // namespace parallux::throughput
