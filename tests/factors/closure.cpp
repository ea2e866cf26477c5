#include <doctest/doctest.h>

#include "factors/form_factors.h"
#include "factors/solids.h"

using namespace parallux;
using namespace parallux::test;

TEST_CASE("rows of closed convex solids sum to 1") {
    // Fails when an edge or a pair of edges is left out, when touching edges are not integrated
    // whole, or with a wrong 2π.
    for (int cuts : {1, 2, 3})
        CHECK(worst_row(box({1, 1, 1}, {cuts, cuts, cuts})) < 1e-10);
    CHECK(worst_row(box({0.2, 1, 7}, {1, 2, 3})) < 1e-10);
    CHECK(worst_row(triangles(box({1, 1, 1}, {1, 1, 1}))) < 1e-10);
    Solid tetrahedron = solid({{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.4, 0.3}, {0.3, 0.2, 0.8}},
                              {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
    CHECK(worst_row(tetrahedron) < 1e-10);
    Solid prism = solid({{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0}, {0, 0, 2}, {1, 0, 2}, {0.3, 0.8, 2}},
                        {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
    CHECK(worst_row(prism) < 1e-10);
    Solid octahedron = solid(
        {{1, 0, 0}, {-1.2, 0, 0}, {0, 0.7, 0}, {0, -1, 0}, {0, 0, 2}, {0, 0, -0.4}},
        {{0, 2, 4}, {0, 3, 4}, {1, 2, 4}, {1, 3, 4}, {0, 2, 5}, {0, 3, 5}, {1, 2, 5}, {1, 3, 5}});
    CHECK(worst_row(octahedron) < 1e-10);
    // A cube without one corner: triangle, squares and pentagons.
    Solid cut = solid({{0, 0, 0},
                       {1, 0, 0},
                       {1, 1, 0},
                       {0, 1, 0},
                       {0, 0, 1},
                       {1, 0, 1},
                       {0, 1, 1},
                       {1, 1, 0.5},
                       {1, 0.6, 1},
                       {0.7, 1, 1}},
                      {{0, 1, 2, 3},
                       {0, 1, 5, 4},
                       {0, 3, 6, 4},
                       {7, 8, 9},
                       {1, 2, 7, 8, 5},
                       {2, 3, 6, 9, 7},
                       {4, 5, 8, 9, 6}});
    CHECK(worst_row(cut) < 1e-10);
}

TEST_CASE("rows of skewed solids with edges that overlap in part sum to 1") {
    // Fails when collinear edges are taken for equal or disjoint, at T-junctions, and where nearly
    // parallel edges leave the closed form.
    Map shear{{1, 0.2, 0}, {0.4, 1.1, 0.1}, {-0.3, 0.5, 0.9}};
    CHECK(worst_row(mapped(shear, box({1, 1, 1}, {1, 1, 1}))) < 1e-10);
    CHECK(worst_row(mapped(shear, box({1, 1, 1}, {1, 2, 3}))) < 1e-10);
    CHECK(worst_row(mapped(shear, triangles(box({1, 1, 1}, {1, 2, 1})))) < 1e-10);
    CHECK(worst_row(mapped(odd_rotation(), triangles(box({1, 1, 0.1}, {1, 2, 3})))) < 1e-10);
    for (double taper : {1e-13, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3, 9e-3, 2e-2, 0.3}) {
        double t = 1 - taper;
        Solid frustum = solid(
            {{0, 0, 0},
             {1, 0, 0},
             {1, 1, 0},
             {0, 1, 0},
             {0, 0, 1},
             {t, 0, 1},
             {t, t, 1},
             {0, t, 1}},
            {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
        CHECK(worst_row(mapped(odd_rotation(), frustum)) < 1e-10);
    }
}

TEST_CASE("rows of a room under a roof that is nearly flat sum to 1") {
    // Fails when nearly parallel edges that touch are integrated on too few pieces, or taken for
    // parallel, or when a sliver's normal leans along it. The gable's triangle is as low as the
    // roof rises: the corners' rounding is that much larger a share of it.
    for (double rise : {1e-9, 1e-7, 1e-5, 1e-3, 9e-3, 2e-2}) {
        double top = 1 + rise;
        Solid room = solid({{0, 0, 0},
                            {1, 0, 0},
                            {1, 0, 1},
                            {0.4, 0, top},
                            {0, 0, 1},
                            {0, 2, 0},
                            {1, 2, 0},
                            {1, 2, 1},
                            {0.4, 2, top},
                            {0, 2, 1}},
                           {{0, 1, 2, 3, 4},
                            {5, 6, 7, 8, 9},
                            {0, 1, 6, 5},
                            {1, 2, 7, 6},
                            {2, 3, 8, 7},
                            {3, 4, 9, 8},
                            {4, 0, 5, 9}});
        CAPTURE(rise);
        CHECK(worst_row(room) < 1e-10);
        CHECK(worst_row(mapped(odd_rotation(), triangles(room))) < 1e-10 + 1e-15 / rise);
    }
}

TEST_CASE("faces of a regular tetrahedron see each other with 1/3") {
    // Fails with a wrong closed form of edges at an angle, whatever cancels in a row's sum.
    Solid regular = solid({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                          {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
    for (std::size_t k = 1; k < 4; ++k)
        CHECK(form_factor(regular[0], regular[k]) == doctest::Approx(1.0 / 3).epsilon(1e-11));
}
