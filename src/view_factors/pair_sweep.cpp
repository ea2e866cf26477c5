#include "view_factors/pair_sweep.h"

#include <algorithm>

#include "parallel.h"

namespace parallux {

namespace {

// Entries that the workers together keep before they are added up: some tens of MiB.
constexpr std::size_t most_entries = std::size_t(1) << 21;
// Of large scenes, a bundle is work for all threads, and one projection memory enough.
constexpr std::size_t many_surfaces = 1 << 13;

}  // namespace

// A worker's own; no two workers write to one cache line.
struct alignas(64) PairSweep::Buffers {
    std::shared_ptr<Projector::Workspace> workspace;
    TilePairs pairs;
    LineCounts counts;
};

PairSweep::PairSweep(const Scene& scene, const Patches& patches, const NodeMap& nodes,
                     const SkyDome& dome, unsigned threads, PairCounts& counts)
    : scene_(scene),
      nodes_(nodes),
      dome_(dome),
      threads_(threads),
      counts_(counts),
      projector_(scene, patches),
      buffers_(threads) {
    for (Buffers& buffers : buffers_)
        buffers.workspace = projector_.make_workspace();
}

PairSweep::~PairSweep() = default;

std::uint32_t PairSweep::at_once() const {
    return scene_.surfaces.size() > many_surfaces ? 1 : std::max(16u, 4 * threads_);
}

void PairSweep::bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count) {
    projections_.resize(std::max<std::size_t>(projections_.size(), count));
    if (count == 1)
        projector_.project(make_bundle(lattice, first), projections_[0], threads_);
    else
        parallel_for(threads_, count, 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k)
                projector_.project(make_bundle(lattice, first + k), projections_[k]);
        });
    std::vector<std::size_t> before(count + 1, 0);
    for (std::uint32_t k = 0; k < count; ++k)
        before[k + 1] = before[k] + projections_[k].tiles();
    auto follow = [&](std::size_t tile, unsigned worker) {
        const std::size_t k = static_cast<std::size_t>(
            std::upper_bound(before.begin(), before.end(), tile) - before.begin() - 1);
        follow_tile(projections_[k], tile - before[k], worker);
    };
    // As many tiles at once as the buffers are to hold.
    for (std::size_t done = 0; done < before.back();) {
        const double room = entries_a_tile_ > 0 ? most_entries / entries_a_tile_ : 64;
        const std::size_t round =
            std::min(before.back() - done, static_cast<std::size_t>(std::clamp(room, 1.0, 1e6)));
        parallel_for(threads_, round, 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            for (std::size_t tile = done + begin; tile < done + end; ++tile)
                follow(tile, worker);
        });
        done += round;
        const std::uint64_t held = counts_.buffered();
        entries_a_tile_ = std::max(static_cast<double>(held) / static_cast<double>(round), 1.0);
        if (held > most_entries / 2)
            counts_.apply(threads_);
    }
    counts_.apply(threads_);
    take_up();
}

void PairSweep::follow_tile(const Projection& projection, std::size_t tile, unsigned worker) {
    Buffers& buffers = buffers_[worker];
    TilePairs& pairs = buffers.pairs;
    projector_.pairs(projection, tile, *buffers.workspace, pairs);
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
    leave(pairs.last, dome_.part(projection.bundle.direction));
    leave(pairs.first, dome_.part(-projection.bundle.direction));
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
