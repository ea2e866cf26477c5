#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

#include "factors/form_factors.h"
#include "factors/solids.h"
#include "parallux/error.h"
#include "parallux/spectrum.h"

using namespace parallux;
using namespace parallux::test;

namespace {

const Polygon floor_square = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
const Polygon ceiling_square = parallelogram({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
const Polygon wall_square = parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 1});

// J. Howell, A catalog of radiation heat transfer configuration factors, C-11: rectangles
// a × b, directly opposed at distance c; X = a/c, Y = b/c.
double opposed(double X, double Y) {
    double x = std::sqrt(1 + X * X), y = std::sqrt(1 + Y * Y);
    return 2 / (pi * X * Y) *
           (std::log(x * y / std::sqrt(1 + X * X + Y * Y)) + X * y * std::atan(X / y) +
            Y * x * std::atan(Y / x) - X * std::atan(X) - Y * std::atan(Y));
}

// C-14: rectangles w × l and h × l at 90° with the common edge l; from the first, W = w/l, H = h/l.
double hinged(double W, double H) {
    double w = W * W, h = H * H, s = std::sqrt(w + h);
    return (W * std::atan(1 / W) + H * std::atan(1 / H) - s * std::atan(1 / s) +
            0.25 * (std::log((1 + w) * (1 + h) / (1 + w + h)) +
                    w * std::log(w * (1 + w + h) / ((1 + w) * (w + h))) +
                    h * std::log(h * (1 + w + h) / ((1 + h) * (w + h))))) /
           (pi * W);
}

}  // namespace

TEST_CASE("rectangles meet the catalogue's closed forms") {
    // Fails with a wrong sign or factor in a term of either sum of 16, and with a wrong 2π.
    CHECK(form_factor(floor_square, ceiling_square) ==
          doctest::Approx(0.199824895698).epsilon(1e-11));
    CHECK(form_factor(floor_square, wall_square) == doctest::Approx(0.200043776075).epsilon(1e-11));
    double worst = 0;
    for (double p : {0.1, 0.3, 1.0, 2.5, 20.0})
        for (double q : {0.1, 0.7, 1.0, 4.0, 30.0}) {
            Polygon low = parallelogram({0, 0, 0}, {p, 0, 0}, {0, q, 0});
            Polygon high = parallelogram({0, 0, 1}, {0, q, 0}, {p, 0, 0});
            worst = std::fmax(worst, std::fabs(form_factor(low, high) / opposed(p, q) - 1));
            Polygon lying = parallelogram({0, 0, 0}, {p, 0, 0}, {0, 1, 0});
            Polygon standing = parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, q});
            worst = std::fmax(worst, std::fabs(form_factor(lying, standing) / hinged(p, q) - 1));
        }
    CHECK(worst < 1e-10);
}

TEST_CASE("opposed squares far apart keep their digits") {
    // Fails when the closed sum is used where its terms cancel: at 1000 some 1e-2 of it is left
    // wrong. 1/r⁴ about the axis, by the moments of the sides' differences: ⟨ρ²⟩ = 1/3,
    // ⟨ρ⁴⟩ = 17/90, and the next term below 1/d⁶.
    for (double d : {30.0, 100.0, 1000.0, 1e5}) {
        Polygon far = parallelogram({0, 0, d}, {0, 1, 0}, {1, 0, 0});
        double d2 = d * d, series = (1 - 2 / (3 * d2) + 17 / (30 * d2 * d2)) / (pi * d2);
        CHECK(std::fabs(form_factor(floor_square, far) / series - 1) < 1e-10 + 1 / (d2 * d2 * d2));
    }
}

TEST_CASE("exchange is reciprocal and does not depend on place, axes or scale") {
    // Fails when a way measures one polygon in the other's frame only (a dropped origin, an axis
    // taken for another), or with a wrong power of the scale.
    Polygon shifted = parallelogram({0.3, -0.2, 1.7}, {0, 2, 0}, {0.4, 0, 0});
    Polygon upright = parallelogram({-0.5, 0.4, 0.2}, {0, 1, 0}, {0, 0, 3});
    Polygon triangle{{0.2, 0.1, 2}, {-0.4, 1.3, 1.5}, {1.4, 0.9, 0.8}};
    Map rotation = odd_rotation();
    for (const Polygon& other : {ceiling_square, wall_square, shifted, upright, triangle}) {
        double value = exchange_area(floor_square, other);
        CHECK(value > 0.01);
        CHECK(exchange_area(other, floor_square) == doctest::Approx(value).epsilon(1e-11));
        CHECK(form_factor(other, floor_square) * area(other) ==
              doctest::Approx(form_factor(floor_square, other)).epsilon(1e-11));
        CHECK(exchange_area(rotation(floor_square), rotation(other)) ==
              doctest::Approx(value).epsilon(1e-11));
        Map larger{{1e3, 0, 0}, {0, 1e3, 0}, {0, 0, 1e3}};
        CHECK(exchange_area(larger(floor_square), larger(other)) ==
              doctest::Approx(1e6 * value).epsilon(1e-11));
    }
}

TEST_CASE("long strips with a common edge tend to 1 - sin(α/2)") {
    // Fails with a wrong normal of the inclined strip or a wrong angle between edges. What the
    // ends let out falls as 1 / length.
    for (double angle : {0.2, pi / 4, pi / 2, 2.0, 3.0}) {
        double limit = 1 - std::sin(angle / 2), last = 0;
        for (double length : {10.0, 100.0, 1000.0}) {
            Polygon lying = parallelogram({0, 0, 0}, {1, 0, 0}, {0, length, 0});
            Polygon inclined =
                parallelogram({0, 0, 0}, {0, length, 0}, {std::cos(angle), 0, std::sin(angle)});
            double missing = limit - form_factor(lying, inclined);
            CHECK(missing > 0);
            CHECK(missing < 1 / length);
            if (last > 0)
                CHECK(last / missing == doctest::Approx(10).epsilon(0.1));
            last = missing;
        }
    }
}

TEST_CASE("a polygon's factor is the sum over its parts") {
    // Fails when the way chosen for a part (triangle, far, touching) disagrees with the whole's.
    Polygon inclined = parallelogram({0, 0, 0}, {0, 1, 0}, {0.5, 0.2, 1});
    for (const Polygon& to : {ceiling_square, wall_square, inclined}) {
        double sum = 0;
        for (int i = 0; i < 7; ++i)
            for (int j = 0; j < 5; ++j) {
                Vec u = (to[1] - to[0]) / 7.0, v = (to[3] - to[0]) / 5.0;
                Polygon part = parallelogram(to[0] + double(i) * u + double(j) * v, u, v);
                for (const Polygon& piece : triangles({part}))
                    sum += form_factor(floor_square, piece);
            }
        CHECK(sum == doctest::Approx(form_factor(floor_square, to)).epsilon(1e-10));
    }
}

TEST_CASE("plates close together and turned a little add up") {
    // Fails when nearly parallel edges that pass close to each other are not integrated on pieces
    // about their closest approach.
    for (double gap : {1e-2, 1e-4, 1e-6})
        for (double turn : {1e-5, 1e-3, 8e-3}) {
            Vec u = Vec(std::cos(turn), std::sin(turn), 0), v = Vec(-u.y, u.x, 0);
            Vec corner = Vec(0.5, 0.5, gap) - 0.5 * (u + v);
            Polygon lid = parallelogram(corner, v, u);
            double sum = 0;
            for (Vec strip : {Vec(0, 0.3, 0), Vec(0.3, 0.25, 0), Vec(0.55, 0.45, 0)})
                sum +=
                    form_factor(floor_square, parallelogram(corner + strip.x * v, strip.y * v, u));
            CAPTURE(gap);
            CAPTURE(turn);
            CHECK(std::fabs(form_factor(floor_square, lid) - sum) < 1e-11);
            CHECK(sum < 1);
            CHECK(sum > 1 - 3 * (gap + turn));
        }
}

TEST_CASE("what lies behind the other's plane takes no part") {
    // Fails when either cut is missing, or keeps the wrong side.
    Polygon deep = parallelogram({0, 0, -2}, {0, 1, 0}, {0, 0, 3});
    CHECK(form_factor(floor_square, deep) ==
          doctest::Approx(form_factor(floor_square, wall_square)).epsilon(1e-11));
    Polygon wide = parallelogram({-4, 0, 0}, {5, 0, 0}, {0, 1, 0});
    CHECK(exchange_area(wide, wall_square) ==
          doctest::Approx(exchange_area(floor_square, wall_square)).epsilon(1e-11));
    Polygon crossing{{0.2, 0.1, -1}, {0.4, 0.9, -1}, {0, 0.5, 1}};
    Polygon above{{0.1, 0.3, 0}, {0.2, 0.7, 0}, {0, 0.5, 1}};
    for (const Polygon& half : {crossing, turned_over(crossing)}) {
        Polygon rest =
            glm::dot(area_vector(half), area_vector(above)) > 0 ? above : turned_over(above);
        // The two sides of one triangle see the two sides of its plane.
        CHECK(form_factor(floor_square, half) ==
              doctest::Approx(form_factor(floor_square, rest)).epsilon(1e-11));
        CHECK(form_factor(floor_square, rest) > 0.01);
    }
}

TEST_CASE("polygons that do not face each other exchange nothing") {
    // Fails when a side is not looked at; a polygon with too many corners must not pass.
    CHECK(exchange_area(floor_square, turned_over(ceiling_square)) == 0);
    CHECK(exchange_area(turned_over(floor_square), ceiling_square) == 0);
    CHECK(exchange_area(floor_square, turned_over(wall_square)) == 0);
    CHECK(exchange_area(floor_square, floor_square) == 0);
    CHECK(exchange_area(floor_square, parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0})) == 0);
    CHECK(exchange_area(floor_square, Polygon{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}) == 0);
    CHECK(form_factor(Polygon{}, floor_square) == 0);
    CHECK_THROWS_AS((Polygon{{}, {}, {}, {}, {}, {}, {}, {}}), const Error&);
}

TEST_CASE("a point's factor meets the closed forms and is the limit of small patches") {
    // Fails with a wrong 2π, a wrong direction of the edges, or without the cut at the horizon.
    for (double a : {0.1, 1.0, 8.0})
        for (double b : {0.2, 1.0, 5.0}) {
            // Parallel, the point below a corner at distance 1; then perpendicular, from the
            // horizon up to a, at distance 1, b wide. The part below the horizon adds nothing.
            double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
            Polygon over = parallelogram({0, 0, 1}, {0, b, 0}, {a, 0, 0});
            double parallel = (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * pi);
            CHECK(point_form_factor({0, 0, 0}, {0, 0, 1}, over) ==
                  doctest::Approx(parallel).epsilon(1e-12));
            Polygon beside = parallelogram({-1, 0, -3}, {0, b, 0}, {0, 0, a + 3});
            double perpendicular = (std::atan(b) - std::atan(b / x) / x) / (2 * pi);
            CHECK(point_form_factor({0, 0, 0}, {0, 0, 1}, beside) ==
                  doctest::Approx(perpendicular).epsilon(1e-12));
        }
    CHECK(point_form_factor({0, 0, 2}, {0, 0, 1}, ceiling_square) == 0);
    CHECK(point_form_factor({0, 0, 2}, {0, 0, -1}, ceiling_square) == 0);
    CHECK(point_form_factor({0, 0, 0}, {0, 0, -1}, ceiling_square) == 0);
    // In the plane of the polygon, whichever way it looks.
    for (double z : {-1.0, 1.0})
        CHECK(point_form_factor({0.5, 0.5, 1}, glm::normalize(Vec(1, 0, z)), ceiling_square) == 0);
    // A patch about the point differs by its size squared.
    Polygon triangle{{0.2, 0.1, 2}, {-0.4, 1.3, 1.5}, {1.4, 0.9, 0.8}};
    for (double size : {1e-2, 1e-3, 1e-4})
        for (const Polygon& to : {ceiling_square, wall_square, triangle}) {
            Polygon patch =
                parallelogram({0.4 - size / 2, 0.3 - size / 2, 0}, {size, 0, 0}, {0, size, 0});
            CHECK(std::fabs(form_factor(patch, to) -
                            point_form_factor({0.4, 0.3, 0}, {0, 0, 1}, to)) < size * size + 1e-10);
        }
}
