#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "lines/edge_walk.h"
#include "lines/ray_scene.h"
#include "made_scene.h"
#include "parallux/patches.h"
#include "support/tile_line.h"

// The projector on surfaces of every kind: parity of closed solids, order of hits, the pairs that
// both its ways give, and the tracer's hits on the same lines.

using namespace parallux;
using fuzz::require;

namespace {

// Everything that is judged of one bundle.
class Judge {
public:
    Judge(const Scene& scene, const Patches& patches, const Bundle& bundle, bool closed)
        : scene_(scene),
          projector_(scene, patches),
          layered_(scene, patches, Projector::Surfaces::many),
          rays_(scene, 1),
          bundle_(bundle),
          closed_(closed) {}

    void judge() {
        auto workspace = projector_.make_workspace(), other = layered_.make_workspace();
        Projection projection, layers;
        projector_.project(bundle_, projection);
        layered_.project(bundle_, layers);
        IntersectionLists lists;
        Total listed, painted, sorted;
        for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
            projector_.lists(projection, tile, *workspace, lists);
            TilePairs pairs;
            append_pairs(lists, pairs);
            listed.add(pairs);
            painted.add(pairs_of(projector_, projection, tile, *workspace));
            for (std::size_t k = 0; k < lists.lines(); ++k)
                judge_line(test::tile_line(projector_, projection, bundle_, tile, k),
                           lists.hits.data() + lists.start[k], lists.start[k + 1] - lists.start[k]);
        }
        // Its tiles are of another size.
        for (std::size_t tile = 0; tile < layers.tiles(); ++tile)
            sorted.add(pairs_of(layered_, layers, tile, *other));
        same(listed, painted);
        same(listed, sorted);
    }

private:
    // What all tiles come to.
    struct Total {
        std::uint64_t hits = 0, nonempty = 0, odd = 0;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        std::array<std::vector<std::uint32_t>, 4> ends;

        void add(const TilePairs& tile) {
            hits += tile.hits, nonempty += tile.nonempty, odd += tile.odd;
            for (std::size_t k = 0; k < tile.from.count; ++k)
                pairs.emplace_back(tile.from.ids[k], tile.to.ids[k]);
            const std::array lists{&tile.first, &tile.last, &tile.into_backs, &tile.from_backs};
            for (std::size_t end = 0; end < ends.size(); ++end)
                ends[end].insert(ends[end].end(), lists[end]->ids.begin(),
                                 lists[end]->ids.begin() + lists[end]->count);
        }
        void sort() {
            std::sort(pairs.begin(), pairs.end());
            for (std::vector<std::uint32_t>& end : ends)
                std::sort(end.begin(), end.end());
        }
    };

    static TilePairs pairs_of(const Projector& projector, const Projection& projection,
                              std::size_t tile, Projector::Workspace& workspace) {
        TilePairs pairs;
        projector.pairs(projection, tile, workspace, pairs);
        return pairs;
    }

    void same(Total& a, Total& b) const {
        a.sort(), b.sort();
        require(a.hits == b.hits, "as many hits in lists and pairs");
        require(a.nonempty == b.nonempty && a.odd == b.odd, "the same counts in lists and pairs");
        // Of three surfaces in one place, each two have an order, and all three perhaps none.
        require(three_in_one_place_ || (a.pairs == b.pairs && a.ends == b.ends),
                "the same pairs from lists and pairs");
    }

    // In spacings, from a line to the nearest edge of a surface as the bundle sees it.
    double to_edge(const test::TileLine& line) const {
        double nearest = 1e300;
        auto across = [&](std::uint32_t corner) {
            const glm::dvec3 p = (scene_.positions[corner] - projector_.centre()) / bundle_.spacing;
            return glm::dvec2(glm::dot(p, bundle_.x), glm::dot(p, bundle_.y));
        };
        for (const Surface& surface : scene_.surfaces) {
            const int corners = surface.shape() == Shape::triangle ? 3 : 4;
            // Seen edge-on it is a part of a straight line, and the tracer hits it anywhere on
            // that.
            const bool edge_on =
                std::abs(glm::dot(surface_normal(scene_, surface), bundle_.direction)) < 1e-6;
            for (int k = 0; k < corners; ++k) {
                const glm::dvec2 a = across(surface.corner[k]),
                                 b = across(surface.corner[(k + 1) % corners]) - a;
                const glm::dvec2 p = glm::dvec2(line.x, line.y) - a;
                const double along = glm::dot(p, b) / std::max(glm::dot(b, b), 1e-300);
                const double t = edge_on ? along : std::clamp(along, 0.0, 1.0);
                nearest = std::min(nearest, glm::length(p - t * b));
            }
        }
        return nearest;
    }

    // How far snapping and rounding may move a surface's depth, metres.
    double slack(std::uint32_t surface) const {
        const double cosine =
            std::abs(glm::dot(surface_normal(scene_, scene_.surfaces[surface]), bundle_.direction));
        return 2 * bundle_.spacing / fixed_one / std::max(cosine, 1e-9) +
               1e-5 * projector_.radius();
    }

    void judge_line(const test::TileLine& line, const Hit* hits, std::size_t count) {
        if (closed_)
            require(count % 2 == 0, "an even number of hits in closed solids");
        for (std::size_t k = 1; k < count; ++k)
            require(hits[k].depth >=
                        hits[k - 1].depth - (slack(hits[k].surface) + slack(hits[k - 1].surface)) /
                                                projector_.radius(),
                    "hits by depth");
        for (std::size_t k = 2; k < count; ++k)
            if (hits[k].depth - hits[k - 2].depth <
                (slack(hits[k].surface) + slack(hits[k - 2].surface)) / projector_.radius())
                three_in_one_place_ = true;
        if (to_edge(line) < 2.0 / fixed_one + 1e-4 * projector_.radius() / bundle_.spacing)
            return;
        rays_.all(line.origin, bundle_.direction, 10 * projector_.radius(), traced_);
        require(traced_.size() == count, "as many hits as the tracer, away from edges");
        // The same surfaces; depths place by place, by which near ones may change places.
        std::vector<std::uint32_t> a, b;
        for (std::size_t k = 0; k < count; ++k) {
            a.push_back(hits[k].surface);
            b.push_back(traced_[k].surface);
        }
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t j = 0; j < count; ++j)
                if (a[k] == b[j])
                    require(std::abs((hits[k].depth + 2) * projector_.radius() - traced_[j].t) <=
                                slack(a[k]),
                            "depths as the tracer's");
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        require(a == b, "the same surfaces as the tracer, away from edges");
    }

    const Scene& scene_;
    Projector projector_, layered_;
    RayScene rays_;
    Bundle bundle_;
    bool closed_;
    std::vector<SurfaceHit> traced_;
    bool three_in_one_place_ = false;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const unsigned kind = bytes.byte();
    const double spacings[4] = {0.25, 0.125, 0.07, 0.03};
    const Bundle bundle = fuzz::bundle(bytes, spacings[kind / 4 % 4]);
    Scene scene = fuzz::solids(bytes);
    const bool closed = kind % 2 == 0;
    if (!closed)
        fuzz::add_sheets(scene, bytes, 1 + bytes.below(8));
    if (scene.surfaces.empty())
        return 0;
    Judge(scene, make_patches(scene), bundle, closed).judge();
    return 0;
}
