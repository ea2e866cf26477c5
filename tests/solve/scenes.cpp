#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "parallux/solve.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Scene own_scene(const char* name) {
    return load_scene(std::string(PARALLUX_SCENES "/") + name);
}

double scene_area(const Scene& scene) {
    double area = 0;
    for (const Surface& surface : scene.surfaces)
        area += surface_area(scene, surface);
    return area;
}

}  // namespace

TEST_CASE("the paper's scene of 12150 patches: its list lengths and lines a patch") {
    // Printed: 1.38, 2.33, and 1474, 1164 and 655 lines for twelve million. Expected exactly: a
    // line of the sphere of radius R crosses area A 2A / (4 π R²) times. Fails when the sphere, the
    // walls' grids or the dropping of duplicates is wrong (planted: radius 0.91).
    Scene scene = own_scene("paper_12150.json");
    Patches patches = make_patches(scene);
    REQUIRE(patches.count() == 12150);
    SolveSettings settings;
    settings.method = Method::lines;
    settings.first_shot = FirstShot::off;
    settings.lines = 12'000'000;
    Solution solution = solve(scene, patches, settings);
    REQUIRE(solution.counts.lines == 12'000'000);
    double lines = 12e6, disc = pi * 0.81;
    double list = static_cast<double>(solution.counts.hits) / lines;
    // A line meets at most a few surfaces, so that a list's length spreads by about 1.3.
    CHECK(std::fabs(list - scene_area(scene) / (2 * disc)) < 4 * 1.3 / std::sqrt(lines));
    CHECK(list == doctest::Approx(1.38).epsilon(0.005 / 1.38));
    double nonempty = double(solution.counts.hits) / double(solution.counts.nonempty);
    CHECK(std::fabs(nonempty - 2.33) < 0.005);
    // Means over all patches of walls, large cube and small cubes, to the paper's last digit.
    double sums[3] = {}, counts[3] = {};
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        int kind = patches.area[patch] > 6e-4 ? 0 : patches.area[patch] > 4e-4 ? 1 : 2;
        sums[kind] += static_cast<double>(solution.crossings[patch]);
        ++counts[kind];
    }
    CHECK(counts[0] == 9600);
    CHECK(counts[1] == 1350);
    CHECK(counts[2] == 1200);
    const double printed[3] = {1474, 1164, 655};
    for (int kind = 0; kind < 3; ++kind) {
        double mean = sums[kind] / counts[kind];
        // Poisson spread of the mean over the kind, and half of the last digit.
        double spread = std::sqrt(printed[kind] / counts[kind]);
        CHECK(std::fabs(mean - printed[kind]) < 4 * spread + 0.5);
    }
}

TEST_CASE("no line fails its parity in any closed scene of ours, over 1e7 lines each") {
    // Fails when a scene is not closed to the last bit, or when a row rule is not half open.
    int closed = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PARALLUX_SCENES)) {
        std::string name = entry.path().filename().string();
        std::string ending = entry.path().extension().string();
        if ((ending != ".json" && ending != ".gltf") || name.find("schema") != std::string::npos)
            continue;
        Scene scene = load_scene(entry.path());
        if (!is_closed(scene))
            continue;
        ++closed;
        PatchSettings coarse;
        coarse.count = 600;
        Patches patches = make_patches(scene, coarse);
        SolveSettings settings;
        settings.first_shot = FirstShot::off;
        LineSphere sphere = line_sphere(scene);
        settings.bundles = 200;
        settings.line_spacing = sphere.radius / 200;
        Solution solution = solve(scene, patches, settings);
        CHECK_MESSAGE(solution.counts.lines >= 10'000'000, name);
        CHECK_MESSAGE(solution.counts.odd == 0, name);
        CHECK_MESSAGE(solution.counts.met_backs == 0, name);
        CHECK(solution.leaks == 0);
        for (std::int64_t residual : solution.energy.residual)
            CHECK(residual == 0);
        for (std::int64_t escaped : solution.energy.escaped)
            CHECK(escaped == 0);
    }
    CHECK(closed >= 10);
}

TEST_CASE("our furnace, L-shaped room and corridor: projector and tracer agree with each other") {
    for (const char* name : {"furnace.json", "l_room.json", "naive_rule.json"}) {
        Scene scene = own_scene(name);
        Patches patches = make_patches(scene);
        SolveSettings settings;
        settings.bundles = 512;
        settings.lines_per_patch = 1;
        std::vector<Sample> bundles = over_seeds(scene, patches, settings, 32);
        settings.method = Method::lines;
        settings.batch = 8;
        settings.first_shot = FirstShot::off;
        std::vector<Sample> lines = over_seeds(scene, patches, settings, 32, 500);
        double bound = sidak_bound(bundles.size(), 32);
        CHECK_MESSAGE(worst_difference(bundles, lines) < bound, name);
        if (std::string(name) == "furnace.json")
            CHECK(worst_z(bundles, [](std::size_t) { return 2.0; }) < bound);
    }
}

TEST_CASE("one hash of the paper's scene for any number of threads, with bundles and with lines") {
    Scene scene = own_scene("paper_12150.json");
    Patches patches = make_patches(scene);
    for (Method method : {Method::bundles, Method::lines}) {
        std::uint64_t hash = 0;
        for (unsigned threads : {1u, 2u, 3u, 7u}) {
            SolveSettings settings;
            settings.method = method;
            settings.bundles = 40;
            settings.threads = threads;
            settings.first_shot_rays = 100'000;
            Solution solution = solve(scene, patches, settings);
            if (threads == 1)
                hash = solution.hash;
            CHECK(solution.hash == hash);
            CHECK(solution.energy.residual[0] == 0);
        }
    }
}
