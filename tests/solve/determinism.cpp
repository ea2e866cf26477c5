#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "parallux/error.h"
#include "parallux/solve.h"
#include "solve/memory.h"
#include "support/hand_made.h"
#include "transfer/banks.h"
#include "vectors.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Scene mixed_scene() {
    Material wall = grey(0.6), lamp = grey(0.4, 2, true);
    Scene scene = room({wall, wall, wall, wall, wall, lamp}, 6);
    scene.bands = 3;
    scene.materials[5].emission[1] = 1;
    scene.materials[5].emission[2] = 0.25f;
    add_turned_cube(scene, {0.4, 0.5, 0.45}, 0.3, 4, grey(0.8));
    add_light_and_sky(scene);
    return scene;
}

}  // namespace

TEST_CASE("equal bits and a residual of 0 on any number of threads") {
    // Fails when energy is added in floating point, when a bundle depends on its worker, or when
    // the batch follows the threads (each planted and seen).
    Scene scene = mixed_scene();
    Patches patches = make_patches(scene);
    for (Method method : {Method::bundles, Method::lines})
        for (Direction direction : {Direction::bidirectional, Direction::oriented}) {
            std::uint64_t hash = 0;
            for (unsigned threads : {1u, 2u, 3u, 7u, 16u}) {
                SolveSettings settings;
                settings.method = method;
                settings.direction = direction;
                settings.bundles = 200;
                settings.threads = threads;
                settings.first_shot_rays = 30000;
                Solution solution = solve(scene, patches, settings);
                if (threads == 1)
                    hash = solution.hash;
                CHECK(solution.hash == hash);
                for (std::uint32_t band = 0; band < 3; ++band) {
                    CHECK(solution.energy.residual[band] == 0);
                    CHECK(solution.energy.emitted[band] > 0);
                }
            }
            SolveSettings other;
            other.method = method;
            other.direction = direction;
            other.bundles = 200;
            other.first_shot_rays = 30000;
            other.seed = 2;
            CHECK(solve(scene, patches, other).hash != hash);
        }
}

TEST_CASE("equal bits whether workers have banks of their own or share one") {
    // Memory allows seven banks, but not 16. Fails when the last tiles of a batch are not added
    // to the shared bank (planted: the last round not applied).
    Scene scene = mixed_scene();
    for (Surface& surface : scene.surfaces)
        surface.grid_u = surface.grid_v = 150;
    Patches patches = make_patches(scene);
    for (Direction direction : {Direction::bidirectional, Direction::oriented}) {
        std::uint64_t hash = 0;
        for (unsigned threads : {1u, 2u, 7u, 16u}) {
            SolveSettings settings;
            settings.direction = direction;
            settings.bundles = 12;
            settings.threads = threads;
            settings.first_shot_rays = 30000;
            settings.max_memory = std::uint64_t(340) << 20;
            REQUIRE(Banks::count(patches.count(), 3, threads, bank_limit(settings)) ==
                    (threads < 16 ? threads : 1));
            Solution solution = solve(scene, patches, settings);
            if (threads == 1)
                hash = solution.hash;
            CHECK(solution.hash == hash);
            for (std::uint32_t band = 0; band < 3; ++band)
                CHECK(solution.energy.residual[band] == 0);
        }
    }
}

TEST_CASE("equal bits with every instruction set") {
    // Few surfaces are painted, many go through layers; bands from one to eight. Fails when a
    // vector is loaded from where none begins (seen as a crash), or when the dither of a band in
    // merge() counts from the vector's first (planted, seen).
    Scene few = mixed_scene();
    few.lights.clear();
    Scene many = few;
    add_ball(many, {0.7, 0.3, 0.7}, 0.2, 20, grey(0.6));
    for (Scene& scene : {std::ref(few), std::ref(many)})
        for (std::uint32_t bands : {1u, 3u, 4u, 7u, 8u}) {
            scene.bands = bands;
            const Patches patches = make_patches(scene);
            std::uint64_t hash = 0;
            std::size_t sets = 0;
            for (const char* set : vector_sets()) {
                if (!use_vectors(set))
                    continue;
                CHECK(vectors_in_use() == std::string(set));
                SolveSettings settings;
                settings.bundles = 100;
                settings.lines_per_patch = 40;  // several tiles a bundle
                settings.first_shot = FirstShot::off;
                const Solution solution = solve(scene, patches, settings);
                CHECK(solution.energy.residual[0] == 0);
                if (sets++ == 0)
                    hash = solution.hash;
                CHECK(solution.hash == hash);
            }
            CHECK(sets > 1);
            CHECK(use_vectors("auto"));
        }
}

TEST_CASE("a scene scaled by a power of two has the same radiosities, twice the light twice them") {
    // To the last bit. Fails when a length or a power is compared with a number of its own
    // (planted: an epsilon of 1e-6 metres in the projector).
    Scene scene = mixed_scene();
    scene.lights.clear();  // their intensity is not per area
    SolveSettings settings;
    settings.bundles = 128;
    settings.first_shot_rays = 20000;
    Solution plain = solve(scene, make_patches(scene), settings);
    for (double scale : {0x1p-12, 0x1p9}) {
        Scene scaled = scene;
        for (glm::dvec3& p : scaled.positions)
            p *= scale;
        Solution other = solve(scaled, make_patches(scaled), settings);
        CHECK(other.radiosity == plain.radiosity);
    }
    Scene brighter = scene;
    for (Material& material : brighter.materials)
        for (float& e : material.emission.value)
            e *= 2;
    for (float& l : brighter.sky.zenith.value)
        l *= 2;
    Solution twice = solve(brighter, make_patches(brighter), settings);
    for (std::size_t k = 0; k < plain.radiosity.size(); ++k)
        REQUIRE(twice.radiosity[k] == 2 * plain.radiosity[k]);
}

TEST_CASE("a closed box in a lit world is exactly black inside") {
    // Fails when a near tie at an edge is left to rounding, or a leftover is spread evenly.
    for (bool two_sided : {false, true}) {
        Scene scene = room(grey(0.5, 0, two_sided), 8);
        scene.sky.kind = Sky::Kind::uniform;
        scene.sky.zenith = Spectrum::constant(1);
        Light light;
        light.position = {0.5, 0.5, 3};
        light.intensity = Spectrum::constant(50);
        scene.lights = {light};
        Patches patches = make_patches(scene);
        SolveSettings settings;
        settings.bundles = 4096;
        Solution solution = solve(scene, patches, settings);
        std::size_t lit = 0;
        for (const SurfaceGrid& grid : patches.grids)
            for (std::uint32_t cell = 0; cell < grid.nu * grid.nv; ++cell) {
                CHECK(solution.radiosity[grid.front + cell] == 0);
                if (two_sided)
                    lit += solution.radiosity[grid.back + cell] > 0;
            }
        CHECK(lit == (two_sided ? patches.count() / 2 : 0));
    }
}

// Failed while exact first shots left out, in closed scenes, all that a patch lies behind: right
// from outside of solids alone. Lamps lit the inside of boxes through their walls.
TEST_CASE("a closed box in a lit room is exactly black inside, whatever the first shot") {
    for (bool two_sided : {false, true})
        for (FirstShot first : {FirstShot::exact, FirstShot::rays, FirstShot::off}) {
            Scene scene = room(grey(0.5, 10), 4, glm::dvec3(-2), glm::dvec3(2));
            add_turned_cube(scene, glm::dvec3(0.1, 0.2, 0.1), 1, 3, grey(0.7, 0, two_sided));
            add_turned_cube(scene, glm::dvec3(0.1, 0.2, 0.1), 0.3, 3, grey(0.7));
            Patches patches = make_patches(scene);
            SolveSettings settings;
            settings.bundles = 64;
            settings.first_shot = first;
            Solution solution = solve(scene, patches, settings);
            for (std::size_t s = 6; s < scene.surfaces.size(); ++s) {
                const SurfaceGrid& grid = patches.grids[s];
                for (std::uint32_t cell = 0; cell < 9; ++cell) {
                    CHECK((solution.irradiance[grid.front + cell] == 0) == (s >= 12));
                    if (grid.back != none)
                        CHECK(solution.irradiance[grid.back + cell] == 0);
                }
            }
        }
}

TEST_CASE("a stopped run is marked, balanced, and near the truth") {
    // Fails when a partial result is not scaled to the emission that was sent.
    Scene scene = room(grey(0.5, 1), 3);
    Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.bundles = 1024;
    settings.batch = 16;
    settings.first_shot = FirstShot::off;
    int calls = 0;
    Solution solution = solve(scene, patches, settings, [&](const Progress& progress) {
        CHECK(progress.done <= 1);
        return ++calls < 12;
    });
    CHECK(solution.partial);
    CHECK(solution.bundles < 200);
    CHECK(solution.bundles > 12);
    CHECK(solution.energy.residual[0] == 0);
    double mean = 0;
    for (float b : solution.radiosity)
        mean += b / double(patches.count());
    CHECK(mean == doctest::Approx(2).epsilon(0.01));
}

TEST_CASE("settings that contradict each other, or memory that is not there, are refused") {
    Scene scene = room(grey(0.5, 1), 3);
    Patches patches = make_patches(scene);
    auto fault = [&](const SolveSettings& settings) {
        try {
            solve(scene, patches, settings);
        } catch (const Error& error) {
            return error.fault();
        }
        return Fault::internal;
    };
    SolveSettings both;
    both.bundles = 10;
    both.lines = 10;
    CHECK(fault(both) == Fault::usage);
    SolveSettings small;
    small.max_memory = 1 << 20;
    CHECK(fault(small) == Fault::memory);
    SolveSettings fine;
    fine.line_spacing = 1e-9;
    CHECK(fault(fine) == Fault::usage);
}
