#pragma once

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "parallux/lines.h"

namespace parallux::test {

/// A pair list as sorted values, whatever its order.
inline std::vector<std::uint64_t> sorted(const PatchList& a, const PatchList* b = nullptr) {
    std::vector<std::uint64_t> values;
    for (std::size_t k = 0; k < a.count; ++k)
        values.push_back(std::uint64_t(a.ids[k]) << 32 | (b ? b->ids[k] : 0));
    std::sort(values.begin(), values.end());
    return values;
}

/// Both ways to the pairs of every tile of some bundles agree: painted (or in layers, of many
/// surfaces), and by ordered lists.
inline void compare(const Scene& scene, double lines_across, std::size_t& pairs_seen,
                    std::uint64_t bundles = 60,
                    Projector::Surfaces surfaces = Projector::Surfaces::any) {
    Patches patches = make_patches(scene);
    Projector projector(scene, patches, surfaces);
    auto workspace = projector.make_workspace();
    Projection projection;
    IntersectionLists lists;
    for (std::uint64_t b = 0; b < bundles; ++b) {
        Bundle bundle =
            make_bundle({5, 60, DirectionSet::random, 2 * projector.radius() / lines_across}, b);
        if (b % 10 == 0) {
            // Along an axis: faces seen from their edges, corners on lines.
            bundle.direction = {b % 20 ? 1 : 0, b % 20 ? 0 : 1, 0};
            bundle.x = {0, 0, 1};
            bundle.y = glm::dvec3(bundle.direction.y, -bundle.direction.x, 0);
            bundle.offset_x = bundle.offset_y = 0;
        }
        projector.project(bundle, projection);
        for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
            TilePairs painted, listed;
            projector.pairs(projection, tile, *workspace, painted);
            projector.lists(projection, tile, *workspace, lists);
            append_pairs(lists, listed);
            REQUIRE(painted.lines == listed.lines);
            REQUIRE(painted.nonempty == listed.nonempty);
            REQUIRE(painted.hits == listed.hits);
            REQUIRE(painted.odd == listed.odd);
            REQUIRE(sorted(painted.from, &painted.to) == sorted(listed.from, &listed.to));
            REQUIRE(sorted(painted.first) == sorted(listed.first));
            REQUIRE(sorted(painted.last) == sorted(listed.last));
            REQUIRE(sorted(painted.into_backs) == sorted(listed.into_backs));
            REQUIRE(sorted(painted.from_backs) == sorted(listed.from_backs));
            pairs_seen += painted.from.count;
        }
    }
}

}  // namespace parallux::test
