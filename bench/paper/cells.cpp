#include "paper/cells.h"

namespace parallux::paper {

namespace {

constexpr Variant oriented{"oriented", Method::lines, Direction::oriented, FirstShot::off};
constexpr Variant oriented_shot{"oriented, first shot exact", Method::lines, Direction::oriented,
                                FirstShot::exact};
constexpr Variant bidirectional{"bidirectional", Method::lines, Direction::bidirectional,
                                FirstShot::off};

}  // namespace

std::vector<Cell> all_cells() {
    constexpr const char *s6 = "paper_scene1_6", *s54 = "paper_scene1_54",
                         *s600 = "paper_scene1_600";
    constexpr const char *t114 = "paper_scene2_114", *t456 = "paper_scene2_456",
                         *t1824 = "paper_scene2_1824", *third = "paper_scene3";
    return {
        {1, s6, 6, 1'000, oriented, 0.0009254},
        {1, s6, 6, 10'000, oriented, 0.0000885},
        {1, s6, 6, 100'000, oriented, 0.0000081},
        {1, s54, 54, 1'000, oriented, 0.0073325},
        {1, s54, 54, 10'000, oriented, 0.0008175},
        {1, s54, 54, 100'000, oriented, 0.0000796},
        {1, s54, 54, 1'000'000, oriented, 0.0000080},
        {1, s600, 600, 10'000, oriented, 0.0079969},
        {1, s600, 600, 100'000, oriented, 0.0008868},
        {1, s600, 600, 1'000'000, oriented, 0.0000888},
        {1, s600, 600, 10'000'000, oriented, 0.0000088},

        {2, t114, 114, 10'000, oriented, 0.0010487},
        {2, t114, 114, 100'000, oriented, 0.0001092},
        {2, t114, 114, 1'000'000, oriented, 0.0000113},
        {2, t456, 456, 10'000, oriented, 0.0041131},
        {2, t456, 456, 100'000, oriented, 0.0004458},
        {2, t456, 456, 1'000'000, oriented, 0.0000453},
        {2, t1824, 1824, 100'000, oriented, 0.0017342},
        {2, t1824, 1824, 1'000'000, oriented, 0.0001792},
        {2, t1824, 1824, 10'000'000, oriented, 0.0000180},

        {3, s6, 6, 1'000, oriented, 0.0007985},
        {3, s6, 6, 10'000, oriented, 0.0000789},
        {3, s6, 6, 100'000, oriented, 0.0000079},
        {3, s54, 54, 1'000, oriented, 0.009267, true},
        {3, s54, 54, 10'000, oriented, 0.0007775},
        {3, s54, 54, 100'000, oriented, 0.0000801},
        {3, s54, 54, 1'000'000, oriented, 0.0000080},

        {4, s6, 6, 1'000, oriented_shot, 0.0000833},
        {4, s6, 6, 10'000, oriented_shot, 0.0000083},
        {4, s6, 6, 100'000, oriented_shot, 0.0000008},
        {4, s54, 54, 1'000, oriented_shot, 0.0009188, true},
        {4, s54, 54, 10'000, oriented_shot, 0.0001084},
        {4, s54, 54, 100'000, oriented_shot, 0.0000112},
        {4, s54, 54, 1'000'000, oriented_shot, 0.0000011},
        {4, s600, 600, 100'000, oriented_shot, 0},
        {4, s600, 600, 1'000'000, oriented_shot, 0},

        {5, third, 54, 1'000, oriented, 0.0457937},
        {5, third, 54, 10'000, oriented, 0.0051473},
        {5, third, 54, 100'000, oriented, 0.0005056},
        {5, third, 54, 1'000'000, oriented, 0.0000505},
        {5, third, 54, 1'000, oriented_shot, 0.0008846},
        {5, third, 54, 10'000, oriented_shot, 0.0001051},
        {5, third, 54, 100'000, oriented_shot, 0.0000105},
        {5, third, 54, 1'000'000, oriented_shot, 0.0000011},

        {6, s6, 6, 1'000, bidirectional, 0.0003190},
        {6, s6, 6, 10'000, bidirectional, 0.0000298},
        {6, s6, 6, 100'000, bidirectional, 0.0000039},
        {6, s54, 54, 1'000, bidirectional, 0.0031117},
        {6, s54, 54, 10'000, bidirectional, 0.0003121},
        {6, s54, 54, 100'000, bidirectional, 0.0000315},
        {6, s54, 54, 1'000'000, bidirectional, 0.0000031},
        {6, s600, 600, 100'000, bidirectional, 0},
        {6, s600, 600, 1'000'000, bidirectional, 0},
    };
}

const char* caption(int table) {
    switch (table) {
        case 1:
            return "scene 1, oriented, against the exact solution ([Sbert93] of many lines)";
        case 2:
            return "scene 2, oriented, against [Sbert93] on the same lines (to counts)";
        case 3:
            return "scene 1, oriented, against the exact solution";
        case 4:
            return "scene 1, oriented, first shot exact";
        case 5:
            return "scene 3, oriented, without and with exact first shot";
        default:
            return "scene 1, bidirectional";
    }
}

std::vector<Variant> bundle_variants(const Variant& paper) {
    // Random directions want δ no smaller than a patch, the lattice half of one.
    return {{"bundles, random directions", Method::bundles, Direction::bidirectional,
             paper.first_shot, DirectionSet::random, 1},
            {"bundles, lattice directions", Method::bundles, Direction::bidirectional,
             paper.first_shot, DirectionSet::lattice, 4}};
}

}  // namespace parallux::paper
