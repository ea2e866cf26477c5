#include "factors/visible.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "factors/solids.h"
#include "random.h"

using namespace parallux;
using namespace parallux::test;

namespace {

const Polygon lamp = parallelogram({-1, -1, 2}, {0, 2, 0}, {2, 0, 0});
const glm::dvec3 up(0, 0, 1);

// Cells of a square grid at height z, n × n of them over [-side, side]², those that chosen.
std::vector<Polygon> cells(double z, double side, int n, Random& random, double share) {
    std::vector<Polygon> chosen;
    const double step = 2 * side / n;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            if (random.uniform() < share)
                chosen.push_back(parallelogram({-side + x * step, -side + y * step, z},
                                               {step, 0, 0}, {0, step, 0}));
    return chosen;
}

// Whichever way it faces.
double factor_of(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon) {
    return point_form_factor(point, normal, polygon) +
           point_form_factor(point, normal, turned_over(polygon));
}

}  // namespace

TEST_CASE("what is hidden and what is seen add up to the whole") {
    // Cells of a grid, all within the cone of the lamp, hide as much as they are seen under
    // themselves. Fails when what is cut off by a side is thrown away, and when a side's normal is
    // turned (both planted).
    VisibleScratch scratch;
    Random random(1, 0);
    for (int trial = 0; trial < 200; ++trial) {
        const glm::dvec3 point(0.2 * random.uniform(), 0.2 * random.uniform(), 0);
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3(random.uniform() - 0.5, random.uniform() - 0.5, 1));
        std::vector<Polygon> blockers = cells(1, 0.4, 4, random, 0.5);
        for (std::size_t k = 0; k < blockers.size(); k += 2)
            blockers[k] = turned_over(blockers[k]);
        double hidden = 0;
        for (const Polygon& blocker : blockers)
            hidden += factor_of(point, normal, blocker);
        const double whole = point_form_factor(point, normal, lamp);
        CHECK(visible_form_factor(point, normal, lamp, blockers, scratch) ==
              doctest::Approx(whole - hidden).epsilon(1e-12));
    }
}

TEST_CASE("blockers that overlap hide once, in any order") {
    VisibleScratch scratch;
    Random random(2, 0);
    for (int trial = 0; trial < 50; ++trial) {
        const glm::dvec3 point(random.uniform() - 0.5, random.uniform() - 0.5, 0);
        std::vector<Polygon> blockers;
        for (int k = 0; k < 6; ++k) {
            const double z = 0.3 + 1.4 * random.uniform();
            blockers.push_back(parallelogram(
                {random.uniform() - 0.8, random.uniform() - 0.8, z},
                {random.uniform(), 0.3 * random.uniform(), 0.2 * random.uniform()},
                {0.3 * random.uniform() - 0.5, random.uniform(), 0.1 * random.uniform()}));
        }
        const double once = visible_form_factor(point, up, lamp, blockers, scratch);
        blockers.insert(blockers.end(), blockers.begin(), blockers.begin() + 3);
        std::reverse(blockers.begin(), blockers.end());
        CHECK(visible_form_factor(point, up, lamp, blockers, scratch) ==
              doctest::Approx(once).epsilon(1e-11));
        // Rays on a fine grid of the lamp, each a share of the kernel: by the Monte Carlo error of
        // as many independent ones, which a grid stays below.
        double seen = 0, kernel = 0;
        constexpr int n = 200;
        for (int k = 0; k < n * n; ++k) {
            const glm::dvec3 to(-1 + 2 * (k % n + 0.5) / n, -1 + 2 * (k / n + 0.5) / n, 2);
            const glm::dvec3 way = to - point;
            const double weight = way.z * way.z / std::pow(glm::dot(way, way), 2);
            kernel += weight;
            const bool hidden = std::any_of(blockers.begin(), blockers.end(), [&](auto& b) {
                const glm::dvec3 across = area_vector(b);
                const double t = glm::dot(b[0] - point, across) / glm::dot(way, across);
                if (!(t > 0 && t < 1))
                    return false;
                const glm::dvec3 at = point + t * way;
                double sides = 0;
                for (std::size_t c = 0; c < b.size(); ++c)
                    sides += glm::dot(glm::cross(b.next(c) - b[c], at - b[c]), across) > 0;
                return sides == static_cast<double>(b.size());
            });
            seen += hidden ? 0 : weight;
        }
        const double whole = point_form_factor(point, up, lamp);
        CHECK(std::fabs(once / whole - seen / kernel) < 4 * 0.5 / n);
    }
}

TEST_CASE("what lies behind the lamp, behind the point or beside the way hides nothing") {
    // Fails when blockers are not cut at the lamp's plane (planted).
    VisibleScratch scratch;
    const double whole = point_form_factor({0, 0, 0}, up, lamp);
    const std::vector<Polygon> harmless{
        parallelogram({-1, -1, 2.5}, {2, 0, 0}, {0, 2, 0}),   // above the lamp
        parallelogram({-1, -1, -0.5}, {2, 0, 0}, {0, 2, 0}),  // below the point
        parallelogram({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}),     // in the lamp's plane
        parallelogram({1, -1, 0}, {0, 2, 0}, {0, 0, 2}),      // a wall at the lamp's edge
        parallelogram({0, -1, -1}, {0, 2, 0}, {0, 0, 1}),     // edge on, and below
    };
    CHECK(visible_form_factor({0, 0, 0}, up, lamp, harmless, scratch) ==
          doctest::Approx(whole).epsilon(1e-13));
    const Polygon half = parallelogram({-1, -1, 2}, {0, 2, 0}, {1, 0, 0});
    CHECK(visible_form_factor({-1e-9, 0, 0}, up, lamp, {}, scratch) == doctest::Approx(whole));
    const std::vector<Polygon> upright{parallelogram({0, -9, 0.5}, {0, 18, 0}, {9, 0, 0})};
    CHECK(visible_form_factor({0, 0, 0}, up, lamp, upright, scratch) ==
          doctest::Approx(point_form_factor({0, 0, 0}, up, half)).epsilon(1e-13));
    CHECK(visible_form_factor({0, 0, 3}, up, lamp, {}, scratch) == 0);
    // A wall through the planes of both hides what lies beyond it.
    const std::vector<Polygon> wall{parallelogram({0.25, -9, -5}, {0, 18, 0}, {0, 0, 10})};
    const Polygon rest = parallelogram({-1, -1, 2}, {0, 2, 0}, {1.25, 0, 0});
    CHECK(visible_form_factor({0, 0, 0}, up, lamp, wall, scratch) ==
          doctest::Approx(point_form_factor({0, 0, 0}, up, rest)).epsilon(1e-13));
}

TEST_CASE("a shaft leaves out what hides nothing, and only that") {
    const Polygon ground = parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const Shaft shaft(ground, lamp);
    CHECK(shaft.holds(parallelogram({0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0})));
    CHECK(shaft.holds(parallelogram({0, 0, 0}, {0, 0.1, 0}, {0, 0, 1})));
    CHECK_FALSE(shaft.holds(parallelogram({1, -1, 0}, {0, 2, 0}, {0, 0, 2})));  // a wall
    CHECK_FALSE(shaft.holds(parallelogram({0, 0, 2.1}, {1, 0, 0}, {0, 1, 0})));
    CHECK_FALSE(shaft.holds(parallelogram({0, 0, -1}, {1, 0, 0}, {0, 1, 0})));
    CHECK_FALSE(shaft.holds(parallelogram({5, 0, 1}, {1, 0, 0}, {0, 1, 0})));
    CHECK_FALSE(shaft.holds(lamp));
    // Within the box of both, beside the way. Fails when the sides are left out (planted).
    const Polygon small = parallelogram({-1, -1, 0}, {0.1, 0, 0}, {0, 0.1, 0});
    const Polygon above = parallelogram({0.9, 0.9, 2}, {0, 0.1, 0}, {0.1, 0, 0});
    CHECK(Shaft(small, above).holds(parallelogram({-0.2, -0.2, 1}, {0.4, 0, 0}, {0, 0.4, 0})));
    CHECK_FALSE(Shaft(small, above).holds(parallelogram({0.5, -1, 1}, {0.4, 0, 0}, {0, 0.4, 0})));

    // Random ones: what hides something from some point is held. Fails when a side is turned
    // (planted).
    VisibleScratch scratch;
    Random random(3, 0);
    int hiding = 0, left_out = 0;
    auto somewhere = [&] {
        return glm::dvec3(random.uniform(), random.uniform(), random.uniform());
    };
    for (int trial = 0; trial < 3000; ++trial) {
        const Polygon from = parallelogram(somewhere(), 0.3 * somewhere(), 0.3 * somewhere());
        const Polygon to = parallelogram(somewhere(), 0.5 * somewhere(), 0.5 * somewhere());
        const Polygon blocker = parallelogram(somewhere(), 0.3 * somewhere(), 0.3 * somewhere());
        const bool held = Shaft(from, to).holds(blocker);
        left_out += !held;
        for (int k = 0; k < 16; ++k) {
            const double u = random.uniform(), v = random.uniform();
            const glm::dvec3 point = from[0] + u * (from[1] - from[0]) + v * (from[3] - from[0]);
            const double whole = point_form_factor(point, unit_normal(from), to);
            const double seen =
                visible_form_factor(point, unit_normal(from), to, {&blocker, 1}, scratch);
            if (seen < whole * (1 - 1e-9)) {
                ++hiding;
                CHECK(held);
            }
        }
    }
    CHECK(hiding > 500);
    CHECK(left_out > 1000);
}
