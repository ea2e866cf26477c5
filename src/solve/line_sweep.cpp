#include "solve/line_sweep.h"

#include <algorithm>
#include <bit>

#include "lines/periodic.h"
#include "parallel.h"
#include "solve/line_walks.h"
#include "solve/pass.h"

namespace parallux {

// A worker's buffers, kept from tile to tile; no two workers write to one cache line.
struct alignas(64) LineSweep::Buffers {
    std::shared_ptr<Projector::Workspace> workspace;
    IntersectionLists lists;
    TilePairs pairs;
    std::vector<glm::dvec3> directions;
    std::vector<SkyQuanta> sky;
};

LineSweep::LineSweep(const Run& run, const TransferState& state, Direction direction, double sky)
    : run_(run),
      state_(state),
      direction_(direction),
      sky_(run.scene.sky.kind == Sky::Kind::dark ? 0 : sky),
      buffers_(run.plan.threads),
      projector_(run.scene, run.patches) {
    for (Buffers& buffers : buffers_)
        buffers.workspace = projector_.make_workspace();
    if (run.banks.shared())
        partition_.emplace(run.patches.count(), run.patches.bands, run.plan.threads);
}

LineSweep::~LineSweep() = default;

void LineSweep::bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    // Of large scenes, a bundle is work for all threads, and one projection memory enough.
    constexpr std::size_t many_surfaces = 1 << 13;
    if (is_periodic(run_.scene))
        repeated(lattice, first, count);
    else if (run_.scene.surfaces.size() > many_surfaces)
        one_by_one(lattice, first, count);
    else if (count >= 4 * run_.plan.threads && !partition_)
        whole_bundles(lattice, first, count);
    else
        side_by_side(lattice, first, count);
}

void LineSweep::lines(std::uint64_t first, std::uint64_t count) {
    const Plan& plan = run_.plan;
    const bool lit = sky_ > 0;
    parallel_for(plan.threads, count, 1024,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     Buffers& buffers = buffers_[worker];
                     trace_lines(*run_.rays, run_.scene, run_.patches, plan.sphere,
                                 run_.settings.seed, first + begin, end - begin, buffers.lists,
                                 lit ? &buffers.directions : nullptr);
                     if (ways_ && ways_->keeping()) {
                         buffers.pairs.clear();
                         append_pairs(buffers.lists, buffers.pairs);
                         ways_->keep(buffers.pairs, first + begin, worker);
                     }
                     buffers.sky.clear();
                     for (std::size_t k = 0; lit && k < buffers.directions.size(); ++k)
                         buffers.sky.push_back(sky_quanta(run_.scene, sky_, buffers.directions[k]));
                     exchange(buffers.lists, state_, direction_, buffers.sky, run_.banks.of(worker),
                              run_.banks.shared(), run_.banks.totals(worker));
                 });
}

void LineSweep::one_by_one(const BundleSettings& lattice, std::uint64_t first,
                           std::uint32_t count) {
    projections_.resize(1);
    for (std::uint32_t k = 0; k < count; ++k) {
        projector_.project(make_bundle(lattice, first + k), projections_[0], run_.plan.threads);
        each_tile(projections_[0].tiles(), [&](std::size_t tile, unsigned worker) {
            follow_tile(projections_[0], tile, worker);
        });
    }
}

// Bundles enough for all threads: each takes one after the other from end to end.
void LineSweep::whole_bundles(const BundleSettings& lattice, std::uint64_t first,
                              std::uint32_t count) {
    projections_.resize(std::max<std::size_t>(projections_.size(), run_.plan.threads));
    parallel_for(run_.plan.threads, count, 1,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     for (std::size_t k = begin; k < end; ++k) {
                         projector_.project(make_bundle(lattice, first + k), projections_[worker]);
                         for (std::size_t tile = 0; tile < projections_[worker].tiles(); ++tile)
                             follow_tile(projections_[worker], tile, worker);
                     }
                 });
}

// Projects the bundles first, then follows the tiles of all of them.
void LineSweep::side_by_side(const BundleSettings& lattice, std::uint64_t first,
                             std::uint32_t count) {
    projections_.resize(std::max<std::size_t>(projections_.size(), count));
    parallel_for(run_.plan.threads, count, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k)
            projector_.project(make_bundle(lattice, first + k), projections_[k]);
    });
    std::vector<std::size_t> tiles_before(count + 1, 0);
    for (std::uint32_t k = 0; k < count; ++k)
        tiles_before[k + 1] = tiles_before[k] + projections_[k].tiles();
    each_tile(tiles_before.back(), [&](std::size_t tile, unsigned worker) {
        std::size_t k = static_cast<std::size_t>(
            std::upper_bound(tiles_before.begin(), tiles_before.end(), tile) -
            tiles_before.begin() - 1);
        follow_tile(projections_[k], tile - tiles_before[k], worker);
    });
}

// Tiles in parallel; where workers share a bank, in rounds, each added up before the next.
template <class Follow>
void LineSweep::each_tile(std::size_t tiles, Follow&& follow) {
    const unsigned threads = run_.plan.threads;
    const std::size_t round = partition_ ? partition_->tiles_a_round() : tiles;
    for (std::size_t first = 0; first < tiles; first += round) {
        parallel_for(threads, std::min(round, tiles - first), 1,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         for (std::size_t tile = first + begin; tile < first + end; ++tile)
                             follow(tile, worker);
                     });
        if (partition_)
            partition_->apply(state_, run_.banks.of(0), threads);
    }
}

void LineSweep::follow_tile(const Projection& projection, std::size_t tile, unsigned worker) {
    Buffers& buffers = buffers_[worker];
    if (run_.walks) {
        projector_.lists(projection, tile, *buffers.workspace, buffers.lists);
        const bool keeping = ways_ && ways_->keeping();
        LineWalks(run_, state_, gathers_, sky_, worker)
            .follow(projection, tile, buffers.lists, projector_.centre(),
                    keeping ? &buffers.pairs : nullptr);
        if (keeping)
            ways_->keep(buffers.pairs, std::bit_cast<std::uint64_t>(projection.bundle.direction.x),
                        worker);
        return;
    }
    projector_.pairs(projection, tile, *buffers.workspace, buffers.pairs);
    exchange_tile(projection.bundle.direction, worker);
}

// Bundles through a scene that repeats: each has copies of its own.
void LineSweep::repeated(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    auto follow = [&](const PeriodicBundle& bundle, Projector::Workspace& workspace,
                      std::size_t tile, unsigned worker) {
        bundle.pairs(tile, workspace, buffers_[worker].lists, buffers_[worker].pairs);
        exchange_tile(bundle.direction(), worker);
    };
    if (!partition_) {
        parallel_for(run_.plan.threads, count, 1,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         for (std::size_t k = begin; k < end; ++k) {
                             const PeriodicBundle bundle(run_.scene, run_.patches,
                                                         make_bundle(lattice, first + k));
                             const auto workspace = bundle.make_workspace();
                             for (std::size_t tile = 0; tile < bundle.tiles(); ++tile)
                                 follow(bundle, *workspace, tile, worker);
                         }
                     });
        return;
    }
    for (std::uint32_t k = 0; k < count; ++k) {
        const PeriodicBundle bundle(run_.scene, run_.patches, make_bundle(lattice, first + k));
        std::vector<std::shared_ptr<Projector::Workspace>> workspaces(run_.plan.threads);
        each_tile(bundle.tiles(), [&](std::size_t tile, unsigned worker) {
            if (!workspaces[worker])
                workspaces[worker] = bundle.make_workspace();
            follow(bundle, *workspaces[worker], tile, worker);
        });
    }
}

void LineSweep::exchange_tile(const glm::dvec3& direction, unsigned worker) {
    Buffers& buffers = buffers_[worker];
    if (ways_ && ways_->keeping())
        ways_->keep(buffers.pairs, std::bit_cast<std::uint64_t>(direction.x), worker);
    SkyQuanta sky;
    if (sky_ > 0)
        sky = sky_quanta(run_.scene, sky_, direction);
    if (partition_)
        partition_->put(worker, buffers.pairs, state_, direction_, sky_ > 0 ? &sky : nullptr,
                        run_.banks.totals(worker));
    else
        exchange_pairs(buffers.pairs, state_, direction_, sky_ > 0 ? &sky : nullptr,
                       run_.banks.of(worker), run_.banks.totals(worker));
}

}  // namespace parallux
