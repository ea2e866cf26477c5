#include "view_factors/pair_sweep.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "lines/periodic.h"
#include "parallel.h"

namespace parallux {

namespace {

// Of large scenes, a bundle is work for all threads, and one projection memory enough.
constexpr std::size_t many_surfaces = 1 << 13;
constexpr std::uint64_t many_lines = 1 << 18, most_weighed_lines = 1 << 22;

}  // namespace

// A worker's own; no two workers write to one cache line.
struct alignas(64) PairSweep::Buffers {
    std::shared_ptr<Projector::Workspace> workspace;
    Projection projection;
    TilePairs pairs;
    std::vector<double> expected;
    IntersectionLists lists;  // of scenes that repeat
    LineCounts counts;
};

PairSweep::PairSweep(const Scene& scene, const Patches& patches, const NodeMap& nodes,
                     const SkyDome& dome, unsigned threads, PairCounts& counts)
    : scene_(scene),
      patches_(patches),
      nodes_(nodes),
      dome_(dome),
      threads_(threads),
      counts_(counts),
      projector_(scene, patches),
      expected_(scene, patches, nodes),
      buffers_(threads) {
    for (Buffers& buffers : buffers_)
        buffers.workspace = projector_.make_workspace();
}

PairSweep::~PairSweep() = default;

std::uint32_t PairSweep::bundles_at_once(const Scene& scene, unsigned threads) {
    if (scene.surfaces.size() > many_surfaces)
        return 1;
    return is_periodic(scene) ? threads : std::max(16u, 4 * threads);
}

void PairSweep::bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    if (is_periodic(scene_))
        repeated(lattice, first, count);
    else
        one_tile(lattice, first, count);
    if (counts_.listed() > counts_.enough())
        counts_.apply(threads_);
    take_up();
}

// Calls follow(bundle, tile, worker) for all tiles of all bundles, as many at once as the buffers
// are to hold.
template <class Follow>
void PairSweep::in_rounds(const std::vector<std::size_t>& tiles, Follow&& follow) {
    std::vector<std::size_t> before(tiles.size() + 1, 0);
    std::partial_sum(tiles.begin(), tiles.end(), before.begin() + 1);
    for (std::size_t done = 0; done < before.back();) {
        const double room =
            entries_a_tile_ > 0 ? static_cast<double>(counts_.enough()) / 2 / entries_a_tile_ : 64;
        const std::size_t round =
            std::min(before.back() - done, static_cast<std::size_t>(std::clamp(room, 1.0, 1e6)));
        const std::uint64_t before_round = counts_.listed();
        parallel_for(threads_, round, 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            for (std::size_t tile = done + begin; tile < done + end; ++tile) {
                const auto k = static_cast<std::size_t>(
                    std::upper_bound(before.begin(), before.end(), tile) - before.begin() - 1);
                follow(k, tile - before[k], worker);
            }
        });
        done += round;
        const std::uint64_t listed = counts_.listed();
        entries_a_tile_ =
            std::max(static_cast<double>(listed - before_round) / static_cast<double>(round), 1.0);
        if (listed > counts_.enough() / 2)
            counts_.apply(threads_);
    }
}

// A bundle of a small scene, by one worker alone.
void PairSweep::follow_alone(const Bundle& bundle, unsigned worker) {
    Buffers& buffers = buffers_[worker];
    projector_.project(bundle, buffers.projection);
    for (std::size_t tile = 0; tile < buffers.projection.tiles(); ++tile) {
        projector_.pairs(buffers.projection, tile, *buffers.workspace, buffers.pairs);
        count_tile(bundle.direction, worker);
    }
    expected_.of(bundle, buffers.expected);
    counts_.end_bundle(worker, worker + 1, buffers.expected);
}

// A bundle that is work for all threads. One of too many lines to keep its counts is taken up
// while it is followed, and its lines, of which each node has many, are not weighed.
void PairSweep::follow_together(const Bundle& bundle) {
    Projection& projection = buffers_[0].projection;
    projector_.project(bundle, projection, threads_);
    auto follow = [&](std::size_t tile, unsigned worker) {
        Buffers& buffers = buffers_[worker];
        projector_.pairs(projection, tile, *buffers.workspace, buffers.pairs);
        count_tile(bundle.direction, worker);
    };
    if (projection.lines() > most_weighed_lines) {
        in_rounds({projection.tiles()},
                  [&](std::size_t, std::size_t tile, unsigned worker) { follow(tile, worker); });
        counts_.end_bundle(0, threads_, {});
        return;
    }
    parallel_for(threads_, projection.tiles(), 1,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     for (std::size_t tile = begin; tile < end; ++tile)
                         follow(tile, worker);
                 });
    expected_.of(bundle, buffers_[0].expected);
    counts_.end_bundle(0, threads_, buffers_[0].expected);
}

void PairSweep::one_tile(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    const double radius = projector_.radius() / lattice.spacing;
    if (count == 1 || pi * radius * radius > static_cast<double>(many_lines)) {
        for (std::uint32_t k = 0; k < count; ++k)
            follow_together(make_bundle(lattice, first + k));
        return;
    }
    parallel_for(threads_, count, 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t k = begin; k < end; ++k)
            follow_alone(make_bundle(lattice, first + k), worker);
    });
}

// Bundles through a scene that repeats: a line joins nodes of one tile by way of any copies.
void PairSweep::repeated(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    std::vector<std::unique_ptr<PeriodicBundle>> bundles(count);
    parallel_for(threads_, count, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k)
            bundles[k] =
                std::make_unique<PeriodicBundle>(scene_, patches_, make_bundle(lattice, first + k));
    });
    std::vector<std::size_t> tiles;
    for (const auto& bundle : bundles)
        tiles.push_back(bundle->tiles());
    // A workspace is of one bundle; workers go through the bundles in turn.
    std::vector<std::size_t> current(threads_, count);
    std::vector<std::shared_ptr<Projector::Workspace>> workspaces(threads_);
    in_rounds(tiles, [&](std::size_t k, std::size_t tile, unsigned worker) {
        if (std::exchange(current[worker], k) != k)
            workspaces[worker] = bundles[k]->make_workspace();
        Buffers& buffers = buffers_[worker];
        bundles[k]->pairs(tile, *workspaces[worker], buffers.lists, buffers.pairs);
        count_tile(bundles[k]->direction(), worker);
    });
    counts_.end_bundle(0, threads_, {});
}

void PairSweep::count_tile(const glm::dvec3& direction, unsigned worker) {
    Buffers& buffers = buffers_[worker];
    const TilePairs& pairs = buffers.pairs;
    const std::uint32_t* node = nodes_.of_patch.data();
    // Neighbouring lines often join the same two: they are put together.
    for (std::size_t k = 0; k < pairs.from.count;) {
        const std::uint32_t from = pairs.from.ids[k], to = pairs.to.ids[k];
        const std::size_t begin = k;
        while (++k < pairs.from.count && pairs.from.ids[k] == from && pairs.to.ids[k] == to) {
        }
        counts_.put(worker, node[from], node[to], static_cast<std::uint32_t>(k - begin));
    }
    const auto beyond = static_cast<std::uint32_t>(counts_.nodes());
    auto leave = [&](const PatchList& list, std::uint32_t outside) {
        for (std::size_t k = 0; k < list.count;) {
            const std::size_t begin = k;
            while (++k < list.count && list.ids[k] == list.ids[begin]) {
            }
            counts_.put(worker, node[list.ids[begin]], beyond + outside,
                        static_cast<std::uint32_t>(k - begin));
        }
    };
    leave(pairs.last, dome_.part(direction));
    leave(pairs.first, dome_.part(-direction));
    leave(pairs.into_backs, dome_.count() + 1);
    leave(pairs.from_backs, dome_.count() + 1);

    LineCounts& counts = buffers.counts;
    counts.lines += pairs.lines;
    counts.nonempty += pairs.nonempty;
    counts.hits += pairs.hits;
    counts.odd += pairs.odd;
    counts.transfers += pairs.from.count;
    counts.met_backs += pairs.into_backs.count + pairs.from_backs.count;
}

void PairSweep::take_up() {
    for (Buffers& buffers : buffers_) {
        line_counts_ += buffers.counts;
        buffers.counts = {};
    }
}

}  // namespace parallux
