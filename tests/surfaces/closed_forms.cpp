#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "parallux/factors.h"
#include "parallux/solve.h"
#include "support/statistics.h"
#include "surfaces/curved_scene.h"

using namespace parallux;
using namespace parallux::test;

TEST_CASE("inside a sphere, any emission and reflectance a patch") {
    // F_ij = A_j / A, so that H is the same everywhere: H = Σ A E / Σ A (1 - ρ). Every patch within
    // its error bar, by Šidák's bound for samples of eight groups. Planted:
    // tests/planted/cell_areas.patch.
    for (int n : {2, 3, 5, 8, 13}) {
        Scene scene = curved_scene(R"({"sphere": {"centre": [0,0,0], "radius": 1, "inward": true},
            "grid": [)" + std::to_string(n) +
                                   ", " + std::to_string(2 * n) + "]}");
        Patches patches = make_patches(scene);
        double sent = 0, kept = 0;
        for (std::size_t k = 0; k < patches.count(); ++k) {
            patches.emission[k] = k % 5 == 0 ? static_cast<float>(1 + k % 7) : 0.0f;
            patches.reflectance[k] = 0.1f + 0.2f * static_cast<float>(k % 4);
            sent += patches.area[k] * static_cast<double>(patches.emission[k]);
            kept += patches.area[k] * (1 - static_cast<double>(patches.reflectance[k]));
        }
        const double uniform = sent / kept;
        SolveSettings settings;
        settings.bundles = 256;
        settings.groups = 8;
        settings.threads = 1;
        settings.line_spacing = 0.05;
        const Solution solution = solve(scene, patches, settings);
        REQUIRE(solution.stderror.size() == patches.count());
        double worst = 0, mean = 0, area = 0;
        for (std::size_t k = 0; k < patches.count(); ++k) {
            const double off = static_cast<double>(solution.irradiance[k]) - uniform;
            const double bar = static_cast<double>(solution.stderror[k]) /
                               static_cast<double>(patches.reflectance[k]);
            worst = std::max(worst, std::fabs(off) / bar);
            mean += patches.area[k] * off;
            area += patches.area[k];
        }
        MESSAGE("grid ", n, ": H ", uniform, ", largest |t| ", worst, " of ",
                sidak_bound(patches.count(), 8), ", mean off ", mean / area);
        CHECK(worst < sidak_bound(patches.count(), 8));
        CHECK(std::fabs(mean / area) < 3e-3 * uniform);
    }
}

namespace {

double factor(const Scene& scene, std::size_t from, std::size_t to) {
    FactorSettings settings;
    settings.between = FactorNodes::surfaces;
    settings.bundles = 4096;
    settings.threads = 1;
    settings.line_spacing = 0.03 * std::sqrt(surface_area(scene, scene.surfaces[0]));
    const Factors factors = view_factors(scene, make_patches(scene), settings);
    for (std::uint64_t k = factors.start[from]; k < factors.start[from + 1]; ++k)
        if (factors.column[k] == to)
            return factors.exchange[k] / factors.nodes[from].area;
    return 0;
}

}  // namespace

TEST_CASE("form factors of spheres, disks and cylinders within a thousandth") {
    {
        const Scene scene = curved_scene(
            R"({"sphere": {"centre": [0,0,0], "radius": 1}, "grid": [4, 8]},
               {"sphere": {"centre": [0,0,0], "radius": 2, "inward": true}, "grid": [4, 8]})");
        CHECK(factor(scene, 0, 1) == doctest::Approx(1).epsilon(1e-3));
        CHECK(factor(scene, 1, 0) == doctest::Approx(0.25).epsilon(1e-3));
    }
    {
        // Coaxial disks (J. Howell's catalogue, C-41): X = 1 + (1 + R2²) / R1².
        const Scene scene = curved_scene(
            R"({"disk": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1}, "grid": [4, 8]},
               {"disk": {"centre": [0,0,1.5], "normal": [0,0,-1], "radius": 0.8}, "grid": [4, 8]})");
        const double r1 = 1 / 1.5, r2 = 0.8 / 1.5, x = 1 + (1 + r2 * r2) / (r1 * r1);
        CHECK(
            factor(scene, 0, 1) ==
            doctest::Approx(0.5 * (x - std::sqrt(x * x - 4 * r2 * r2 / (r1 * r1)))).epsilon(1e-3));
    }
    {
        // A cylinder's inside to itself, by its ends: F = 1 - (√(4 h² + 4 ...)): with h = H / 2 R,
        // F = 1 + h - √(1 + h²) (J. Howell's catalogue, C-78).
        const Scene scene = curved_scene(
            R"({"cylinder": {"base": [0,0,0], "axis": [0,0,2], "radius": 1, "inward": true},
                "grid": [4, 8]},
               {"disk": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1}, "grid": [2, 8]},
               {"disk": {"centre": [0,0,2], "normal": [0,0,-1], "radius": 1}, "grid": [2, 8]})");
        CHECK(factor(scene, 0, 0) == doctest::Approx(1 + 1 - std::sqrt(2.0)).epsilon(1e-3));
    }
}
