#include "output/interpolate.h"

#include <cmath>

#include <doctest/doctest.h>

#include "hand_made.h"

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

// The interpolated field with the rays that it refers to.
struct Interpolated {
    explicit Interpolated(const Case& c, unsigned threads = 2)
        : rays(c.scene, threads), field(c.scene, c.patches, c.solution, rays, threads) {}
    RayScene rays;
    Interpolation field;
};

double value(const Interpolated& interpolated, std::uint32_t surface, double u, double v,
             bool back = false) {
    float h[max_bands];
    interpolated.field.at(surface, back, u, v, h);
    return h[0];
}

// Largest difference between the interpolated field and a formula over a surface.
double largest_error(const Case& c, const Interpolated& field, std::uint32_t s,
                     const hand_made::Field& formula, bool back = false) {
    double largest = 0;
    const Surface& surface = c.scene.surfaces[s];
    dvec3 normal = surface_normal(c.scene, surface) * (back ? -1.0 : 1.0);
    for (int i = 0; i <= 50; ++i)
        for (int j = 0; j <= 50; ++j) {
            double u = i / 50.0, v = j / 50.0;
            if (surface.shape() == Shape::triangle && u + v > 1)
                continue;
            double exact = formula(surface_point(c.scene, surface, u, v), normal);
            largest = std::max(largest, std::abs(value(field, s, u, v, back) - exact));
        }
    return largest;
}

}  // namespace

// Planted errors that fail it: a fit that returns the weighted mean instead of the line's value
// (borders are off by half a cell's slope); corner weights that are mixed up; the clamp without its
// allowance beyond the outermost patches.
TEST_CASE("linear fields come back exactly, also at borders") {
    auto linear = [](const dvec3& p, const dvec3&) { return 20 + 3 * p.x - 2 * p.y + p.z; };
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true);
    c.quad({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 13, 9);
    c.quad({0, 0, 2}, {4, 1, 0}, {0.5, 3, 1}, 7, 11, 1);
    c.triangle({0, 0, 5}, {4, 0, 5}, {1, 3, 5}, 9);
    c.triangle({9, 0, 5}, {9, 3, 5}, {9, 0, 9}, 2, 1);
    c.divide(linear);
    Interpolated field(c);
    for (std::uint32_t s = 0; s < 4; ++s)
        CHECK(largest_error(c, field, s, linear) < 2e-5);
    CHECK(largest_error(c, field, 1, linear, true) < 2e-5);
    CHECK(largest_error(c, field, 3, linear, true) < 2e-5);
}

// Planted error: weights that do not sum to one; a ridge on the value and not on the slope alone.
TEST_CASE("constants come back exactly from strips and single cells") {
    auto constant = [](const dvec3&, const dvec3&) { return 7.25; };
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({0, 0, 0}, {4, 0, 0}, {0, 0.1, 0}, 20, 1);
    c.quad({0, 0, 1}, {4, 0, 0}, {0, 0.1, 0}, 1, 1);
    c.triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2}, 1);
    c.divide(constant);
    Interpolated field(c);
    for (std::uint32_t s = 0; s < 3; ++s)
        CHECK(largest_error(c, field, s, constant) == 0);
}

// Planted error: the clamp left out, so that the fit undershoots beside the step. At borders, where
// a line is followed outwards, an eighth of the step is allowed.
TEST_CASE("no value lies outside the range of the patches around it") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 16, 16);
    c.divide([](const dvec3& p, const dvec3&) { return p.x + p.y < 0.93 ? 1.0 : 100.0; });
    Interpolated field(c);
    for (int i = 0; i <= 100; ++i)
        for (int j = 0; j <= 100; ++j) {
            double h = value(field, 0, i / 100.0, j / 100.0);
            bool border = i < 7 || j < 7 || i > 93 || j > 93;
            CHECK(h >= (border ? 0 : 1 - 1e-5));
            CHECK(h <= 100 + (border ? 12.5 : 1e-4));
        }
}

// Planted error: pairs that are not tested for what stands between them.
TEST_CASE("nothing bleeds under a wall that stands between cells") {
    auto lit = [](const dvec3& p, const dvec3&) { return p.x < 0 ? 1.0 : 0.0; };
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true);
    c.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 16, 16);
    c.quad({0, -2, 0}, {0, 4, 0}, {0, 0, 2}, 8, 4, 1);
    c.divide(lit);
    Interpolated field(c);
    for (int i = 0; i <= 50; ++i)
        for (double v : {0.01, 0.33, 0.5, 0.99}) {
            CHECK(value(field, 0, 0.4999 * i / 50, v) == 1);
            CHECK(value(field, 0, 0.5001 + 0.4999 * i / 50, v) == 0);
        }
}

// Planted errors: torn patches that take part in fits light their neighbours; corners behind the
// wall that are not dropped leak within the cells it crosses.
TEST_CASE("nothing bleeds under a wall that stands across cells") {
    for (double turn : {0.0, 0.31}) {
        Case c;
        c.material(Spectrum::constant(0.5f));
        c.material(Spectrum::constant(0.5f), true);
        c.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 15, 15);
        dvec3 along(4 * std::sin(turn), 4 * std::cos(turn), 0);
        along *= 1.4;
        dvec3 from = dvec3(0.03, 0, 0) - 0.5 * along;
        c.quad(from, along, {0, 0, 2}, 8, 4, 1);
        auto lit = [&](const dvec3& p) {
            return (p.x - from.x) * along.y - (p.y - from.y) * along.x < 0;
        };
        c.divide([&](const dvec3& p, const dvec3&) { return lit(p) ? 1.0 : 0.0; });
        Interpolated field(c);
        for (int i = 0; i <= 300; ++i)
            for (int j = 0; j <= 40; ++j) {
                dvec3 p(-2 + 4 * i / 300.0, -2 + 4 * (j + 0.1) / 41, 0);
                CHECK(value(field, 0, (p.x + 2) / 4, (p.y + 2) / 4) == doctest::Approx(lit(p)));
            }
    }
}

// Planted error: a look from one patch to the other so high that a rod before them parts them.
TEST_CASE("what hangs before a surface does not part it") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 16, 16);
    c.box({-0.02, -2, 0.02}, {0.04, 4, 0.02}, 1);
    auto linear = [](const dvec3& p, const dvec3&) { return 20 + 3 * p.x - 2 * p.y; };
    c.divide(linear);
    CHECK(largest_error(c, Interpolated(c), 0, linear) < 2e-5);
}

// Planted error: hidden parts of patches counted as dark (share always 1) makes a fringe.
TEST_CASE("a box on the floor has no dark fringe") {
    double low = 0.337, high = 0.761;
    auto outside = [&](const dvec3& p, const dvec3& n) {
        bool under = n.z > 0 && p.x > low && p.x < high && p.y > low && p.y < high && p.z == 0;
        return under || n.z < -0.5 ? 0.0 : 5.0;
    };
    for (bool bottom : {true, false}) {
        Case c;
        c.material(Spectrum::constant(0.5f));
        c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 19, 19);
        c.box({low, low, 0}, dvec3(high - low, high - low, 0.4), 4);
        if (!bottom)
            c.scene.surfaces.erase(c.scene.surfaces.begin() + 1);
        c.divide(outside);
        Interpolated field(c);
        double least = 5, most = 5;
        for (int i = 0; i <= 200; ++i)
            for (int j = 0; j <= 200; ++j) {
                double x = i / 200.0, y = j / 200.0;
                if (x > low && x < high && y > low && y < high)
                    continue;
                least = std::min(least, value(field, 0, x, y));
                most = std::max(most, value(field, 0, x, y));
            }
        // The exposed share of a partly covered cell stands on 256 points.
        CHECK(least > 4.9);
        CHECK(most < 5.1);
    }
}

// Planted error: the part above the lamp not told from the rest spreads a bright spot.
TEST_CASE("a lamp close under the ceiling leaves no bright rim") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true, Spectrum::constant(100));
    c.quad({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 16, 16);
    c.quad({0.41, 0.41, 0.995}, {0.18, 0, 0}, {0, 0.18, 0}, 2, 2, 1);
    auto above = [](const dvec3& p) {
        return p.x > 0.41 && p.x < 0.59 && p.y > 0.41 && p.y < 0.59;
    };
    c.divide([&](const dvec3& p, const dvec3&) { return above(p) ? 100.0 : 1.0; });
    Interpolated field(c);
    double most = 0;
    for (int i = 0; i <= 100; ++i)
        for (int j = 0; j <= 100; ++j)
            if (!above({j / 100.0, i / 100.0, 1}))
                most = std::max(most, value(field, 0, i / 100.0, j / 100.0));
    CHECK(most < 2.5);
}

// Planted error: fits that see their own surface only; the jump is then that of two one-sided fits.
TEST_CASE("coplanar neighbours with different grids show no seam") {
    auto smooth = [](const dvec3& p, const dvec3&) {
        return 5 + std::sin(3 * p.x) * std::cos(2 * p.y);
    };
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10, 10);
    c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 17, 13);
    c.divide(smooth);
    Interpolated field(c);
    double jump = 0;
    for (int j = 0; j <= 500; ++j)
        jump =
            std::max(jump, std::abs(value(field, 0, 1, j / 500.0) - value(field, 1, 0, j / 500.0)));
    CHECK(jump < 2e-3);
    CHECK(largest_error(c, field, 0, smooth) < 0.07);
    CHECK(largest_error(c, field, 1, smooth) < 0.07);
}

// Planted error: normals not compared. A floor and a wall that meet keep their own values.
TEST_CASE("nothing is mixed across a crease") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8);
    c.quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 8, 8);
    c.divide([](const dvec3&, const dvec3& n) { return n.z > 0.5 ? 3.0 : 1.0; });
    Interpolated field(c);
    CHECK(value(field, 0, 0, 0.3) == 3);
    CHECK(value(field, 1, 0.3, 0) == 1);
}

// Planted error: smooth surfaces not joined. The field over a tube of 40 sides has no jumps.
TEST_CASE("light is continuous across the edges of a smooth surface") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    int sides = 40;
    auto around = [&](int i) {
        double phi = 2 * pi * (i % sides) / sides;
        return dvec3(std::cos(phi), std::sin(phi), 0);
    };
    for (int i = 0; i < sides; ++i)
        c.quad(around(i), around(i + 1) - around(i), {0, 0, 1}, 1, 6);
    c.divide([](const dvec3& p, const dvec3& n) { return 2 + n.x + 0.5 * p.z; });
    Interpolated field(c);
    for (int i = 0; i < sides; ++i)
        for (double v : {0.0, 0.4, 1.0})
            CHECK(value(field, static_cast<unsigned>(i), 1, v) ==
                  doctest::Approx(value(field, static_cast<unsigned>((i + 1) % sides), 0, v)));
    CHECK(value(field, 0, 0.5, 0.5) == doctest::Approx(3.25).epsilon(0.01));
}

// Planted error: members of a cluster each treated as a patch of their own.
TEST_CASE("a cluster of triangles carries a linear field") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    int n = 24;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            dvec3 p(double(i) / n, double(j) / n, 0), x(1.0 / n, 0, 0), y(0, 1.0 / n, 0);
            c.triangle(p, p + x, p + x + y, 1);
            c.triangle(p, p + x + y, p + y, 1);
        }
    auto linear = [](const dvec3& p, const dvec3&) { return 1 + 2 * p.x + p.y; };
    c.divide(linear);
    // Join squares of 3 × 3 quads; a cluster's irradiance is that at its middle.
    int blocks = n / 3;
    c.patches.area.assign(std::size_t(blocks * blocks), 1.0 / (blocks * blocks));
    c.solution.irradiance.assign(3 * c.patches.area.size(), 0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < 2; ++k) {
                std::uint32_t patch = static_cast<std::uint32_t>(i / 3 * blocks + j / 3);
                c.patches.grids[std::size_t(2 * (i * n + j) + k)].front = patch;
                dvec3 middle((i / 3 + 0.5) / blocks, (j / 3 + 0.5) / blocks, 0);
                for (std::size_t b = 0; b < 3; ++b)
                    c.solution.irradiance[3 * patch + b] = float(linear(middle, middle));
            }
    Interpolated field(c);
    double largest = 0;
    for (std::uint32_t s = 0; s < c.scene.surfaces.size(); ++s)
        largest = std::max(largest, largest_error(c, field, s, linear));
    CHECK(largest < 1e-5);
}

// Planted error: lists or fits that depend on which thread ends first.
TEST_CASE("the same bits on any number of threads") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 40, 40);
    c.box({0.3, 0.3, 0}, {0.3, 0.2, 0.4}, 9);
    c.divide([](const dvec3& p, const dvec3& n) { return 2 + std::sin(9 * p.x * p.y) + n.x; });
    Interpolated one(c, 1), two(c, 2), seven(c, 7);
    for (std::uint32_t s = 0; s < c.scene.surfaces.size(); ++s)
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; j <= 60; ++j) {
                double h = value(one, s, i / 60.0, j / 60.0);
                REQUIRE(h == value(two, s, i / 60.0, j / 60.0));
                REQUIRE(h == value(seven, s, i / 60.0, j / 60.0));
            }
}
