#include <doctest/doctest.h>

#include "view_factors/scenes.h"
#include "view_factors/sky_parts.h"

// Factors from counted lines against closed forms: within the error bars, and 0.1 %. Planted, and
// seen to fail: lines that come in not counted as leaving the other way, backs not counted, lines
// from a node to itself counted once.

using namespace parallux;
using namespace parallux::test;

namespace {

FactorSettings many_lines() {
    FactorSettings settings;
    settings.bundles = 8192;
    settings.sky_from = SkyFrom::lines;
    return settings;
}

}  // namespace

TEST_CASE("the unit cube's faces see each other as they must") {
    const Scene scene = room(grey(0.5), 1);
    const Patches patches = one_each(scene);
    const Factors factors = view_factors(scene, patches, many_lines());
    REQUIRE(factors.nodes.size() == 6);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            const double exact = i == j ? 0 : i / 2 == j / 2 ? 0.199824895698 : 0.200043776075;
            CHECK(std::fabs(factor(factors, i, j) - exact) < 0.001 * 0.2);
            // rms_factor is of five in a row.
            CHECK(std::fabs(factor(factors, i, j) - exact) < 4 * factors.rms_factor);
        }
    CHECK(factors.leaks == 0);
    CHECK(factors.rest == 0);
}

TEST_CASE("plates under the sky: parallel, perpendicular, and what they see beside each other") {
    Scene scene;
    add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "floor");
    add_plate(scene, {0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}, "ceiling");
    add_plate(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 0.5}, "wall");
    const Factors factors = view_factors(scene, one_each(scene), many_lines());
    for (std::uint32_t i = 0; i < 3; ++i) {
        double all = 0;
        for (std::uint32_t j = 0; j < 3; ++j) {
            const double exact =
                i == j ? 0 : form_factor(polygon_of(scene, i), polygon_of(scene, j));
            CHECK(std::fabs(factor(factors, i, j) - exact) < 0.001 * exact + 1e-12);
            all += exact;
        }
        const double rest = outside(factors, i, 0) + outside(factors, i, 1);
        CHECK(std::fabs(rest - (1 - all)) < 0.001 * (1 - all));
        CHECK(outside(factors, i, 2) == 0);
    }
    // The floor sees the sky past the ceiling, and no ground; the ceiling the other way.
    CHECK(outside(factors, 0, 1) == 0);
    CHECK(outside(factors, 1, 0) == 0);
    CHECK(std::fabs(outside(factors, 2, 0) - outside(factors, 2, 1)) < 0.002);
}

TEST_CASE("an inert back is told apart from the sky") {
    Scene scene;
    add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "floor");
    add_plate(scene, {0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, "roof");
    const Factors factors = view_factors(scene, one_each(scene), many_lines());
    Polygon roof = polygon_of(scene, 1);
    const Polygon below{roof[0], roof[3], roof[2], roof[1]};
    const double exact = form_factor(polygon_of(scene, 0), below);
    CHECK(std::fabs(outside(factors, 0, 2) - exact) < 0.001 * exact);
    CHECK(std::fabs(outside(factors, 0, 0) - (1 - exact)) < 0.001 * (1 - exact));
    CHECK(outside(factors, 1, 0) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("balls within each other: the tessellation's own dense answer") {
    const Scene scene = concentric_balls(0.5, 1, 6);
    const Patches patches = one_each(scene);
    FactorSettings settings = many_lines();
    settings.between = FactorNodes::objects;
    const Factors balls = view_factors(scene, patches, settings);
    REQUIRE(balls.nodes.size() == 2);
    const double ratio = balls.nodes[0].area / balls.nodes[1].area;
    CHECK(factor(balls, 0, 1) == doctest::Approx(1).epsilon(1e-12));
    CHECK(factor(balls, 0, 0) == 0);
    CHECK(std::fabs(factor(balls, 1, 0) - ratio) < 0.001 * ratio);
    CHECK(std::fabs(factor(balls, 1, 1) - (1 - ratio)) < 0.001 * (1 - ratio));

    // From the inner one nothing stands between: closed forms.
    settings.between = FactorNodes::surfaces;
    const Factors factors = view_factors(scene, patches, settings);
    const std::uint32_t n = static_cast<std::uint32_t>(scene.surfaces.size());
    double squares = 0, area = 0;
    for (std::uint32_t i = 0; i < n / 2; ++i) {
        area += factors.nodes[i].area;
        for (std::uint32_t j = n / 2; j < n; ++j) {
            const double exact = form_factor(polygon_of(scene, i), polygon_of(scene, j));
            squares += factors.nodes[i].area * std::pow(factor(factors, i, j) - exact, 2);
        }
    }
    const double rms = std::sqrt(squares / area);
    MESSAGE("RMS of a row: " << rms << ", stated " << factors.rms_factor);
    CHECK(rms < 1.5 * factors.rms_factor);
    CHECK(rms < 0.005);
}

TEST_CASE("parts of the sky as a level plate sees them") {
    for (SkyParts parts : {SkyParts::tregenza, SkyParts::reinhart}) {
        Scene scene;
        add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "floor");
        FactorSettings settings = many_lines();
        settings.sky_parts = parts;
        settings.lines_per_patch = 64;
        const Factors factors = view_factors(scene, one_each(scene), settings);
        const std::uint32_t count = parts == SkyParts::tregenza ? 145 : 577;
        REQUIRE(factors.sky_parts == count);
        const double step = pi / 2 / (parts == SkyParts::tregenza ? 7.5 : 14.5);
        const std::uint32_t split = parts == SkyParts::tregenza ? 1 : 2;
        constexpr std::uint32_t of_row[7] = {30, 30, 24, 24, 18, 12, 6};
        std::uint32_t k = 0;
        for (std::uint32_t row = 0; row < 7 * split; ++row) {
            const double low = std::sin(row * step), high = std::sin((row + 1) * step);
            const double exact = high * high - low * low;
            double sum = 0;
            for (std::uint32_t part = 0; part < of_row[row / split] * split; ++part)
                sum += outside(factors, 0, k++);
            // Rows hold some 200 to 1000 of the directions.
            CHECK(std::fabs(sum - exact) < 0.1 * exact);
        }
        const double low = std::sin(7 * split * step);
        CHECK(k == count - 1);
        CHECK(std::fabs(outside(factors, 0, k) - (1 - low * low)) < 0.2 * (1 - low * low));
    }
}

TEST_CASE("parts of the sky begin at north and go by east") {
    const SkyDome dome(SkyParts::tregenza, {0, 0, 1}, {0, 1, 0});
    auto at = [&](double height, double azimuth) {
        const double h = height * pi / 180, a = azimuth * pi / 180;
        return dome.part({std::cos(h) * std::sin(a), std::cos(h) * std::cos(a), std::sin(h)});
    };
    CHECK(at(6, 0) == 0);
    CHECK(at(6, 355) == 0);
    CHECK(at(6, 12) == 1);
    CHECK(at(6, 348) == 29);
    CHECK(at(18, 96) == 30 + 8);
    CHECK(at(90, 0) == 144);
    CHECK(at(-1, 0) == 145);
}
