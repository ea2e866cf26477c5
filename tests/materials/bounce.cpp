#include "materials/bounce.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "materials/shiny.h"
#include "support/statistics.h"

using namespace parallux;
using namespace parallux::test;

// A. Fresnel's and W. Snell's laws, by identities that the formulas are not made of.
TEST_CASE("glass reflects as much as Fresnel says") {
    for (double n : {1.1, 1.33, 1.5, 2.4}) {
        CAPTURE(n);
        const double straight = std::pow((n - 1) / (n + 1), 2);
        CHECK(fresnel(1, n, 1) == doctest::Approx(straight));
        CHECK(fresnel(n, 1, 1) == doctest::Approx(straight));
        CHECK(fresnel(1, n, 0) == doctest::Approx(1));
        // Brewster's angle, tan θ = n: one polarisation is not reflected, the other by cos² 2θ.
        const double brewster = std::atan(n);
        CHECK(fresnel(1, n, std::cos(brewster)) ==
              doctest::Approx(0.5 * std::pow(std::cos(2 * brewster), 2)));
        // G. Stokes: as much from the other side, at the angle of refraction.
        for (double angle : {0.2, 0.7, 1.3}) {
            const double beyond = std::asin(std::sin(angle) / n);
            CHECK(fresnel(1, n, std::cos(angle)) ==
                  doctest::Approx(fresnel(n, 1, std::cos(beyond))));
        }
        const double critical = std::asin(1 / n);
        CHECK(fresnel(n, 1, std::cos(critical + 1e-6)) == 1);
        CHECK(fresnel(n, 1, std::cos(critical - 1e-3)) < 1);
    }
}

TEST_CASE("glass refracts as Snell says, and back the same way") {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, 3));
    for (const glm::dvec3& towards : {glm::dvec3(1, 0, 0.2), glm::dvec3(-1, 2, 2)}) {
        glm::dvec3 in = glm::normalize(towards);
        if (glm::dot(in, normal) > 0)
            in = -in;
        const glm::dvec3 out = refracted(in, normal, 1, 1.5);
        CHECK(glm::length(out) == doctest::Approx(1));
        // n × the part along the surface stays: sines, and the plane of incidence.
        const glm::dvec3 before = glm::cross(normal, in), after = 1.5 * glm::cross(normal, out);
        CHECK(glm::distance(before, after) < 1e-12);
        CHECK(glm::dot(out, normal) < 0);
        CHECK(glm::distance(refracted(-out, -normal, 1.5, 1), -in) < 1e-12);
    }
}

namespace {

// Where light goes in the mean of many ways: shares reflected and let through.
struct Shares {
    double reflected = 0, through = 0;
};

Shares shares(const Material& material, double cosine, bool inside) {
    Random random(1, 0);
    Shares sum;
    constexpr int ways = 200'000;
    const glm::dvec3 in(std::sqrt(1 - cosine * cosine), 0, -cosine);
    for (int k = 0; k < ways; ++k) {
        Weights weights;
        weights.fill(1);
        const Bounce way = bounce(material.specular, material.specular.colour, nullptr, in,
                                  {0, 0, 1}, inside, random, weights);
        (way.through ? sum.through : sum.reflected) += weights[0] / ways;
    }
    return sum;
}

}  // namespace

TEST_CASE("a sheet of glass reflects to and fro between its faces") {
    // R + T² R / (1 - R²), summed here bounce by bounce.
    const double r = fresnel(1, 1.5, 0.6);
    double reflected = r, inside = (1 - r);
    for (int k = 0; k < 100; ++k) {
        inside *= r;
        reflected += inside * (1 - r);
        inside *= r;
    }
    const Shares sheet = shares(glass(1.5, 0, true), 0.6, false);
    CHECK(std::fabs(sheet.reflected - reflected) < 5 * std::sqrt(reflected / 2e5));
    CHECK(sheet.reflected + sheet.through == doctest::Approx(1));
    const Shares body = shares(glass(1.5), 0.6, false);
    CHECK(std::fabs(body.reflected - r) < 5 * std::sqrt(r / 2e5));
    CHECK(shares(glass(1.5), 0.6, true).reflected == doctest::Approx(1));  // sin θ = 0.8 > 1 / 1.5
}

TEST_CASE("Schlick's law joins the two reflectances of a mirror") {
    Material metal = mirror(0.5);
    metal.specular.grazing = Spectrum::constant(1);
    CHECK(shares(metal, 1, false).reflected == doctest::Approx(0.5));
    CHECK(shares(metal, 0.5, false).reflected == doctest::Approx(0.5 + 0.5 / 32));
    CHECK(shares(metal, 1e-6, false).reflected == doctest::Approx(1).epsilon(1e-4));
}

namespace {

// Which of 4 × 8 cells of equal share of the cosine law a direction is in.
constexpr int rings = 4, sectors = 8, cells = rings * sectors;

int cell_of(const glm::dvec3& w) {
    const int ring = std::min(rings - 1, static_cast<int>(rings * (1 - w.z * w.z)));
    const double turn = std::atan2(w.y, w.x) / (2 * pi) + 0.5;
    return ring * sectors + std::min(sectors - 1, static_cast<int>(sectors * turn));
}

}  // namespace

// Light that comes by the cosine law must leave by it, and as often from a to b as from b to a.
// Both hold for the facets' single bounces and for what they give back together.
TEST_CASE("rough mirrors are reciprocal, and lose nothing") {
    for (double alpha : {0.05, 0.3, 1.0}) {
        CAPTURE(alpha);
        const Microfacets rough(alpha);
        Random random(7, 0);
        constexpr int ways = 4'000'000;
        std::vector<double> from_to(cells * cells, 0), to(cells, 0);
        for (int k = 0; k < ways; ++k) {
            const double square = random.uniform(), angle = 2 * pi * random.uniform();
            const double r = std::sqrt(square);
            const glm::dvec3 a(r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - square));
            double along = 0;
            const glm::dvec3 b = rough.sample(a, random, along);
            REQUIRE(b.z > 0);
            REQUIRE(std::fabs(glm::length(b) - 1) < 1e-6);
            from_to[cell_of(a) * cells + cell_of(b)] += 1;
            to[cell_of(b)] += 1;
        }
        const double bound = sidak_bound(cells * cells, 1'000'000);
        double worst = 0, worst_cell = 0;
        for (int a = 0; a < cells; ++a)
            for (int b = 0; b < a; ++b) {
                const double x = from_to[a * cells + b], y = from_to[b * cells + a];
                if (x + y > 20)
                    worst = std::max(worst, std::fabs(x - y) / std::sqrt(x + y));
            }
        for (double count : to)
            worst_cell = std::max(worst_cell, std::fabs(count - double(ways) / cells) /
                                                  std::sqrt(double(ways) / cells));
        CHECK(worst < bound);
        CHECK(worst_cell < bound);
    }
}

// ∫ D G / (4 cos cos') cos' dω over the directions themselves, for a rough one, whose lobe a plain
// grid resolves; D, G as B. Walter et al. write them.
TEST_CASE("facets reflect as much as the integral of GGX") {
    const double alpha = 0.6, square = alpha * alpha;
    const Microfacets rough(alpha);
    auto masking = [&](double z) {
        return 0.5 * (std::sqrt(1 + square * (1 - z * z) / (z * z)) - 1);
    };
    for (double z : {0.1, 0.4, 0.8, 1.0}) {
        CAPTURE(z);
        const glm::dvec3 a(std::sqrt(1 - z * z), 0, z);
        constexpr int steps = 1500;
        double sum = 0;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const double c = (i + 0.5) / steps, angle = 2 * pi * (j + 0.5) / steps;
                const double r = std::sqrt(1 - c * c);
                const glm::dvec3 b(r * std::cos(angle), r * std::sin(angle), c);
                const glm::dvec3 half = glm::normalize(a + b);
                const double h = half.z * half.z;
                const double facing = square / (pi * std::pow(h * (square - 1) + 1, 2));
                sum += facing / (1 + masking(z) + masking(c)) / (4 * z);
            }
        sum *= 2 * pi / (double(steps) * steps);
        CHECK(rough.single(z) == doctest::Approx(sum).epsilon(2e-3));
    }
}
