#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

#include "lines/directions.h"
#include "parallux/lines.h"

using namespace parallux;

namespace {

// χ² of 100 × 100 equal-area cells, in standard deviations from its mean. `squeeze` plants an
// error: directions drawn a little towards the equator.
double uniformity(double squeeze) {
    constexpr int n = 100;
    constexpr int draws = 10'000'000;
    std::vector<double> cells(n * n, 0);
    Random random(7, 1);
    for (int k = 0; k < draws; ++k) {
        glm::dvec3 d = uniform_direction(random);
        d.z *= squeeze;
        int i = std::min(n - 1, int((d.z + 1) / 2 * n));
        int j = std::min(n - 1, int((std::atan2(d.y, d.x) / (2 * pi) + 0.5) * n));
        ++cells[i * n + j];
    }
    double expected = double(draws) / (n * n), chi = 0;
    for (double count : cells)
        chi += (count - expected) * (count - expected) / expected;
    return (chi - (n * n - 1)) / std::sqrt(2.0 * (n * n - 1));
}

}  // namespace

TEST_CASE("directions are uniform") {
    CHECK(std::fabs(uniformity(1)) < 4.5);
    // The planted error must be seen.
    CHECK(uniformity(0.99) > 4.5);
}

TEST_CASE("shuffling is a permutation, another one for another seed") {
    // Fails when a Feistel round is not invertible (planted: left and right both taken from left).
    for (std::uint64_t count : {1, 2, 3, 7, 64, 100, 1000, 4097}) {
        std::vector<int> seen(count, 0);
        int fixed = 0, same = 0;
        for (std::uint64_t k = 0; k < count; ++k) {
            std::uint64_t place = shuffled(k, count, 5);
            REQUIRE(place < count);
            ++seen[place];
            fixed += place == k;
            same += place == shuffled(k, count, 6);
        }
        for (int times : seen)
            REQUIRE(times == 1);
        // A random permutation keeps one in place on average; Poisson, so that 9 has p < 2e-7.
        if (count >= 64) {
            CHECK(fixed < 9);
            CHECK(same < 9);
        }
    }
}

TEST_CASE("the lattice covers the sphere evenly, however it is turned") {
    // The second moments of a uniform direction are I/3; a lattice of D points meets them to a
    // small part of what D random ones would (√(4/45 / D) = 0.0047 on the diagonal). Fails when
    // one hemisphere is left out or z is not uniform.
    BundleSettings settings{3, 4000, DirectionSet::lattice, 0.1};
    double moment[3][3] = {};
    glm::dvec3 mean(0);
    for (std::uint64_t k = 0; k < settings.count; ++k) {
        Bundle bundle = make_bundle(settings, k);
        mean += bundle.direction / double(settings.count);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                moment[i][j] += bundle.direction[i] * bundle.direction[j] / double(settings.count);
    }
    // Every other line is turned about: the senses cancel to a fortieth of what random ones would.
    CHECK(glm::length(mean) < 1 / (40 * std::sqrt(4000.0)));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            CHECK(std::fabs(moment[i][j] - (i == j) / 3.0) < 2e-4);
}

TEST_CASE("a bundle is a pure function with an orthonormal frame") {
    for (DirectionSet set : {DirectionSet::lattice, DirectionSet::random})
        for (std::uint64_t k : {0, 1, 77, 999}) {
            Bundle a = make_bundle({11, 1000, set, 0.25}, k),
                   b = make_bundle({11, 1000, set, 0.25}, k);
            CHECK(a.direction == b.direction);
            CHECK(a.x == b.x);
            CHECK(a.offset_x == b.offset_x);
            CHECK(std::fabs(glm::dot(a.x, a.y)) < 1e-14);
            CHECK(glm::length(glm::cross(a.x, a.y) - a.direction) < 1e-14);
            CHECK(make_bundle({12, 1000, set, 0.25}, k).direction != a.direction);
            // Fails when bundles come twice (planted: index / 2).
            Bundle next = make_bundle({11, 1000, set, 0.25}, k + 1);
            CHECK(next.direction != a.direction);
            CHECK(next.offset_x != a.offset_x);
        }
}
