#pragma once

#include <cstdint>

#include "parallux/lines.h"

namespace parallux::test {

struct Audit {
    std::uint64_t lines = 0, odd = 0, out_of_turn = 0, disordered = 0;
};

// Follows all lines of some bundles: lists must be even, and sides must alternate between meeting
// a back and meeting a front, since all surfaces are closed and one-sided.
inline void audit(const Projector& projector, const Bundle& bundle, Audit& sums) {
    auto workspace = projector.make_workspace();
    Projection projection;
    IntersectionLists lists;
    projector.project(bundle, projection);
    for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
        projector.lists(projection, tile, *workspace, lists);
        sums.lines += lists.lines();
        for (std::size_t line = 0; line < lists.lines(); ++line) {
            std::uint32_t begin = lists.start[line], end = lists.start[line + 1];
            sums.odd += (end - begin) % 2;
            for (std::uint32_t k = begin + 1; k < end; ++k) {
                sums.out_of_turn +=
                    (lists.hits[k - 1].away == none) != (lists.hits[k].toward == none);
                sums.disordered +=
                    lists.hits[k].depth <
                    lists.hits[k - 1].depth - float(0.125 * bundle.spacing / projector.radius());
            }
        }
    }
}

}  // namespace parallux::test
