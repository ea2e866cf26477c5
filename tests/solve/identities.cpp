#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "parallux/patches.h"
#include "parallux/solve.h"
#include "support/hand_made.h"

// What holds of every solution, whatever the noise: light adds up, and inside a sphere all see all
// alike.

using namespace parallux;
using namespace parallux::test;

namespace {

// Twenty triangles, each cut into four `levels` times, corners on the unit sphere, looking inward;
// faces of the upper half have the second material.
Scene icosphere(int levels, const Material& lower, const Material& upper) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {lower, upper};
    scene.objects = {"sphere"};
    const double g = (1 + std::sqrt(5.0)) / 2;
    auto add = [&](const glm::dvec3& p) { scene.positions.push_back(glm::normalize(p)); };
    for (double a : {-1.0, 1.0})
        for (double b : {-g, g})
            add({a, b, 0}), add({0, a, b}), add({b, 0, a});
    std::vector<glm::uvec3> faces;
    auto near = [&](std::uint32_t i, std::uint32_t j) {
        return glm::distance(scene.positions[i], scene.positions[j]) < 1.06;
    };
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t j = i + 1; j < 12; ++j)
            for (std::uint32_t k = j + 1; k < 12; ++k)
                if (near(i, j) && near(j, k) && near(i, k))
                    faces.push_back({i, j, k});
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
        auto between = [&](std::uint32_t i, std::uint32_t j) {
            auto [entry, fresh] = known.try_emplace(std::minmax(i, j), scene.positions.size());
            if (fresh)
                add(scene.positions[i] + scene.positions[j]);
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& f : faces) {
            const glm::uvec3 m(between(f.x, f.y), between(f.y, f.z), between(f.z, f.x));
            for (const glm::uvec3& part : {glm::uvec3(f.x, m.x, m.z), glm::uvec3(f.y, m.y, m.x),
                                           glm::uvec3(f.z, m.z, m.y), m})
                finer.push_back(part);
        }
        faces = finer;
    }
    for (glm::uvec3 f : faces) {
        const auto &a = scene.positions[f.x], &b = scene.positions[f.y], &c = scene.positions[f.z];
        if (glm::dot(glm::cross(b - a, c - a), a) > 0)
            std::swap(f.y, f.z);
        Surface surface;
        surface.corner = {f.x, f.y, f.z, none};
        surface.material = a.z + b.z + c.z > 0;
        surface.grid_u = surface.grid_v = 1;
        scene.surfaces.push_back(surface);
    }
    return scene;
}

// By how much the lit upper half of an icosphere has less irradiance than the sphere's, mean
// emission by area / (1 - ρ): a flat face does not see itself.
double off_the_sphere(int levels) {
    const Scene scene = icosphere(levels, grey(0.5), grey(0.5, 2));
    REQUIRE(is_closed(scene));
    const Patches patches = make_patches(scene, {.clusters = false});
    SolveSettings settings;
    settings.bundles = 4000;
    settings.line_spacing = 0.02;
    settings.groups = 1;
    const Solution solution = solve(scene, patches, settings);
    double emitted = 0, area = 0, upper = 0, received = 0;
    for (std::size_t k = 0; k < patches.count(); ++k) {
        emitted += patches.area[k] * patches.emission[k], area += patches.area[k];
        if (patches.emission[k] > 0)
            received += patches.area[k] * solution.irradiance[k], upper += patches.area[k];
    }
    return 1 - received / upper / (emitted / area / (1 - 0.5));
}

}  // namespace

// Planted, seen: tests/planted/superposed.patch.
TEST_CASE("superposition: two lights together are what they are one by one, on the same lines") {
    // Lines in order and bundles one at a time do the same whatever the light; what is left is the
    // rounding of quanta, and of results to floats.
    for (Method method : {Method::lines, Method::bundles}) {
        CAPTURE(method_name(method));
        SolveSettings settings;
        settings.method = method;
        settings.first_shot = FirstShot::off;
        settings.batch = method == Method::bundles;
        settings.groups = 1;
        settings.lines = 200'000;
        std::vector<Solution> found;
        Patches patches;
        for (int lit : {1, 2, 3}) {
            const Material wall = grey(0.6), one = grey(0.3, lit & 1 ? 3 : 0),
                           other = grey(0.6, lit & 2 ? 0.01 : 0);
            const Scene scene = room({wall, one, wall, wall, other, wall}, 4);
            patches = make_patches(scene);
            found.push_back(solve(scene, patches, settings));
        }
        double error = 0, all = 0;
        for (std::size_t k = 0; k < patches.count(); ++k) {
            const double sum = double(found[0].radiosity[k]) + found[1].radiosity[k];
            error = std::max(error, std::fabs(sum - found[2].radiosity[k]));
            all = std::max(all, sum);
        }
        MESSAGE("off by ", error / all);
        CHECK(error < 1e-5 * all);
    }
}

TEST_CASE("inside icospheres the irradiance comes to the sphere's as the square of the edge") {
    const double coarse = off_the_sphere(0), middle = off_the_sphere(1), fine = off_the_sphere(2);
    MESSAGE(coarse, " ", middle, " ", fine);
    CHECK(std::log2(coarse / middle) > 1.7);
    CHECK(std::log2(middle / fine) > 1.7);
}
