#include <doctest/doctest.h>

#include <map>
#include <utility>

#include "lines/periodic.h"
#include "view_factors/expected_lines.h"
#include "view_factors/pair_sweep.h"
#include "view_factors/scenes.h"

// The counting in sorted rows against a plain one of the same lines: a map of whole numbers, each
// run of equal pairs put in as it comes. Planted, each seen to fail:
// a mark of a column lost (count_rows.h), equal columns of two groups kept apart
// (count_rows.cpp), a bundle's entries weighed anew with the next one's, pairs weighed by one node
// alone (pair_counts.cpp), lines that come in counted to the part of the sky that they go to
// (pair_sweep.cpp).

using namespace parallux;
using namespace parallux::test;

namespace {

using Counts = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t>;

// What counting promises, in its own words and without sparing work.
class PlainCounts {
public:
    PlainCounts(const Scene& scene, const Patches& patches, const NodeMap& nodes,
                const SkyDome& dome)
        : scene_(scene),
          patches_(patches),
          nodes_(nodes),
          dome_(dome),
          n_(static_cast<std::uint32_t>(nodes.nodes.size())),
          expected_(scene, patches, nodes) {}

    Counts counts;

    void bundle(const Bundle& bundle) {
        runs_.clear();
        if (is_periodic(scene_)) {
            const PeriodicBundle repeated(scene_, patches_, bundle);
            const auto workspace = repeated.make_workspace();
            IntersectionLists lists;
            for (std::size_t tile = 0; tile < repeated.tiles(); ++tile) {
                TilePairs pairs;
                repeated.pairs(tile, *workspace, lists, pairs);
                add(pairs, repeated.direction());
            }
        } else {
            const Projector projector(scene_, patches_);
            const auto workspace = projector.make_workspace();
            Projection projection;
            projector.project(bundle, projection);
            for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
                TilePairs pairs;
                projector.pairs(projection, tile, *workspace, pairs);
                add(pairs, bundle.direction);
            }
        }
        weigh(bundle);
    }

private:
    struct Run {
        std::uint32_t i, j, lines;
    };

    // i ≤ j; equal ones that follow each other in a list are one.
    void put(std::uint32_t a, std::uint32_t b, bool follows) {
        const std::uint32_t i = std::min(a, b), j = std::max(a, b);
        if (follows)
            ++runs_.back().lines;
        else
            runs_.push_back({i, j, 1});
    }

    void add(const TilePairs& pairs, const glm::dvec3& direction) {
        auto node = [&](std::uint32_t patch) { return nodes_.of_patch[patch]; };
        for (std::size_t k = 0; k < pairs.from.count; ++k)
            put(node(pairs.from.ids[k]), node(pairs.to.ids[k]),
                k > 0 && pairs.from.ids[k] == pairs.from.ids[k - 1] &&
                    pairs.to.ids[k] == pairs.to.ids[k - 1]);
        auto leave = [&](const PatchList& list, std::uint32_t outside) {
            for (std::size_t k = 0; k < list.count; ++k)
                put(node(list.ids[k]), n_ + outside, k > 0 && list.ids[k] == list.ids[k - 1]);
        };
        leave(pairs.last, dome_.part(direction));
        leave(pairs.first, dome_.part(-direction));
        leave(pairs.into_backs, dome_.count() + 1);
        leave(pairs.from_backs, dome_.count() + 1);
    }

    void weigh(const Bundle& bundle) {
        std::vector<double> expected(n_, 0), weight(n_, 1);
        std::vector<std::uint64_t> met(n_, 0);
        for (const Run& run : runs_) {
            met[run.i] += run.lines;
            if (run.j < n_)
                met[run.j] += run.lines;
        }
        if (!is_periodic(scene_)) {
            expected_.of(bundle, expected);
            for (std::uint32_t k = 0; k < n_; ++k)
                weight[k] = line_weight(expected[k], static_cast<double>(met[k]));
        }
        for (const Run& run : runs_) {
            const double w = run.j < n_ ? std::sqrt(weight[run.i] * weight[run.j]) : weight[run.i];
            counts[{run.i, run.j}] += static_cast<std::uint64_t>(64.0 * run.lines * w + 0.5);
        }
    }

    const Scene& scene_;
    const Patches& patches_;
    const NodeMap& nodes_;
    const SkyDome& dome_;
    std::uint32_t n_;
    ExpectedLines expected_;
    std::vector<Run> runs_;
};

// Boxes in rows on a ground: many nodes that hide each other.
Scene town() {
    Scene scene;
    add_plate(scene, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}, "ground");
    scene.surfaces[0].grid_u = scene.surfaces[0].grid_v = 14;
    for (int x = 0; x < 2; ++x)
        for (int y = 0; y < 2; ++y)
            add_turned_cube(scene, {1.5 + 3 * x, 1.5 + 3 * y, 1.3}, 1 + 0.2 * x, 3, grey(0.3));
    return scene;
}

Counts kept_counts(const PairCounts& counts) {
    Counts kept;
    for (std::size_t shard = 0; shard < counts.shards(); ++shard) {
        const CountRows& rows = counts.rows(shard);
        for (std::size_t row = 0; row < rows.rows(); ++row)
            for (std::uint64_t k = rows.start[row]; k < rows.start[row + 1]; ++k) {
                const auto i = static_cast<std::uint32_t>(shard * counts.shard_nodes() + row);
                CHECK(kept.emplace(std::pair{i, rows.column[k]}, rows.count[k]).second);
            }
    }
    const auto n = static_cast<std::uint32_t>(counts.nodes());
    for (std::uint32_t k = 0; k < counts.outside().size(); ++k)
        if (counts.outside()[k] > 0)
            kept[{k / counts.outsides(), n + k % counts.outsides()}] = counts.outside()[k];
    return kept;
}

}  // namespace

TEST_CASE("every count is that of a plain map, with weights, in groups, in scenes that repeat") {
    Scene tile = town();
    tile.period = {glm::dvec3(6.5, 0, 0), glm::dvec3(0, 6.5, 0)};
    for (const Scene& scene : {town(), concentric_balls(0.5, 1, 10), tile}) {
        const Patches patches = make_patches(scene);
        const NodeMap nodes = make_nodes(scene, patches, FactorNodes::patches);
        const SkyDome dome(SkyParts::tregenza, scene.sky.up, scene.sky.north);
        PlainCounts plain(scene, patches, nodes, dome);
        PairCounts counts(nodes.nodes.size(), dome.count() + 2, 3);
        PairSweep sweep(scene, patches, nodes, dome, 3, counts);
        const std::uint32_t bundles = is_periodic(scene) ? 9 : 33;
        std::uint64_t exits = 0;
        for (std::uint64_t group = 0; group < 3; ++group) {
            const BundleSettings lattice{group + 1, bundles, DirectionSet::lattice, 0.08};
            for (std::uint32_t done = 0; done < bundles; done += 3) {
                sweep.bundles(lattice, done, 3);
                for (std::uint32_t k = 0; k < 3; ++k)
                    plain.bundle(make_bundle(lattice, done + k));
                // Some are taken up late, some at once.
                if (done % 2 == 0)
                    counts.apply(3);
            }
            counts.end_group(3);
        }
        CHECK((kept_counts(counts) == plain.counts));
        std::vector<std::uint64_t> left(nodes.nodes.size(), 0);
        for (const auto& [pair, count] : plain.counts) {
            left[pair.first] += count;
            if (pair.second < left.size())
                left[pair.second] += count;
            exits += count;
        }
        CHECK(counts.exits() == left);
        CHECK(exits > 0);
    }
}
