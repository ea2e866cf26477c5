#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "factors/dilogarithm.h"
#include "factors/solids.h"
#include "factors/ways.h"
#include "parallux/spectrum.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// Uniform numbers in [-1, 1] and rotations from them.
class Draw {
public:
    double number() { return 2 * static_cast<double>(engine_() >> 11) * 0x1p-53 - 1; }
    Vec direction() {
        Vec v{number(), number(), number()};
        double square = glm::dot(v, v);
        return square < 1 && square > 0.01 ? v / std::sqrt(square) : direction();
    }
    Map rotation() {
        Vec x = direction(), y = glm::normalize(glm::cross(x, direction()));
        return {x, y, glm::cross(x, y)};
    }

private:
    std::mt19937_64 engine_{7};
};

Polygon moved(const Polygon& polygon, const Vec& by) {
    Polygon result;
    for (const Vec& corner : polygon)
        result.add(corner + by);
    return result;
}

const Polygon square = parallelogram({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});

}  // namespace

TEST_CASE("closed sums, contours and cubature agree on rectangles at any distance") {
    // Fails with a wrong sign in either closed way, a missing edge, a rule with a wrong weight, or
    // a distance at which a way is no longer good. Grazing pairs are left out of the relative
    // comparison: there only the absolute error is small.
    Draw draw;
    Map rotation = odd_rotation();
    for (double distance : {1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 100.0}) {
        double contours = 0, far = 0, chosen = 0;
        for (int k = 0; k < 400; ++k) {
            Vec to = distance * draw.direction();
            to.z = std::fabs(to.z) + (k % 2 ? 0.01 : 0.51);
            Polygon other = k % 2 ? moved(turned_over(square), to)
                                  : moved(parallelogram({0, -0.5, -0.5}, {0, 0, 1}, {0, 1, 0}), to);
            Polygon a = in_front_of(square, other[0], unit_normal(other));
            if (a.size() < 3)
                continue;
            a = rotation(a);
            other = rotation(other);
            auto closed = rectangle_exchange(a, other);
            REQUIRE(closed);
            double grain = std::fmax(1, distance * distance);
            contours = std::fmax(contours, std::fabs(contour_exchange(a, other) - *closed) / grain);
            double grazing = 1e-3 * area(a) / (distance * distance);
            auto cubature = cubature_exchange(a, other);
            if (cubature && distance < 10 && *closed > grazing)
                far = std::fmax(far, std::fabs(*cubature / *closed - 1));
            double value = exchange_area(a, other);
            if (value > grazing && distance < 10)
                chosen = std::fmax(chosen, std::fabs(value / *closed - 1));
        }
        CAPTURE(distance);
        CHECK(contours < 1e-14);
        CHECK(far < 1e-9);
        CHECK(chosen < 1e-9);
    }
}

TEST_CASE("contours and cubature agree on polygons in general position") {
    // Fails with a wrong dilogarithm term (skew edges), or when the cut of one polygon by the
    // other's plane is not followed by its contour.
    Draw draw;
    for (double distance : {1.5, 2.0, 3.0, 5.0, 10.0}) {
        double worst = 0;
        int pairs = 0;
        for (int k = 0; k < 1000; ++k) {
            Polygon a = draw.rotation()(parallelogram({-0.5, -0.5, 0}, {1, 0.4 * draw.number(), 0},
                                                      {0.4 * draw.number(), 1, 0}));
            Polygon b = moved(draw.rotation()(Polygon{{-0.5, -0.5, 0}, {1, 0, 0}, {-0.5, 0.5, 0}}),
                              distance * draw.direction());
            Polygon part_a = in_front_of(a, b[0], unit_normal(b));
            Polygon part_b = in_front_of(b, a[0], unit_normal(a));
            if (part_a.size() < 3 || part_b.size() < 3)
                continue;
            if (auto cubature = cubature_exchange(part_a, part_b)) {
                ++pairs;
                worst = std::fmax(worst, std::fabs(contour_exchange(part_a, part_b) - *cubature));
            }
        }
        CAPTURE(distance);
        CHECK(pairs > 20);
        CHECK(worst < 2e-12);
    }
}

TEST_CASE("tiny patches above a large polygon keep their digits") {
    // Fails when the contours' sum is used where its terms cancel: at 1e-5 nothing would be left.
    Polygon large{{-1, -1, 1}, {-1.2, 1, 1}, {1.3, 0.8, 1}, {1, -1, 1}};
    for (double size : {1e-2, 1e-3, 1e-5}) {
        Polygon patch{{-size, -size, 0}, {size, -size, 0}, {0, 2 * size, 0}};
        CHECK(std::fabs(form_factor(patch, large) -
                        point_form_factor({0, 0, 0}, {0, 0, 1}, large)) < size * size);
    }
}

TEST_CASE("the dilogarithm's pieces meet closed values") {
    // Fails with a wrong coefficient in either series of Cl₂, or a lost term of Im Li₂.
    CHECK(clausen(pi / 2) == doctest::Approx(0.915965594177219015).epsilon(1e-15));
    CHECK(clausen(pi / 3) == doctest::Approx(1.014941606409653625).epsilon(1e-15));
    CHECK(clausen(2 * pi / 3) == doctest::Approx(1.014941606409653625 * 2 / 3).epsilon(1e-15));
    CHECK(clausen(3 * pi / 2) == doctest::Approx(-clausen(pi / 2)).epsilon(1e-15));
    CHECK(clausen(0) == 0);
    for (double x : {-3.0, -1.0, -0.5})
        for (double theta : {0.1, 1.0, 2.0, 3.0}) {
            // Im Li₂(z) = Σ |z|ᵏ sin(kθ) / k².
            double sum = 0;
            for (int k = 1; k < 100; ++k)
                sum += std::exp(k * x) * std::sin(k * theta) / (k * k);
            CHECK(std::fabs(dilogarithm_sine(x, theta) + clausen(2 * theta) / 2 - sum) < 1e-15);
        }
}
