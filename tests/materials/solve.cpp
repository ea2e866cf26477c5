#include "parallux/solve.h"

#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "materials/furnace.h"
#include "materials/shiny.h"
#include "parallux/error.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// Everything that shines, in a room.
void add_shiny(Scene& scene, double emitted_by_mirrors) {
    add_block(scene, {0.2, 0.2, 0.1}, {0.4, 0.5, 0.4}, glass(1.5));
    add_plate(scene, {0.5, 0.2, 0.3}, {0.3, 0, 0.1}, {0, 0.3, 0.1}, glass(1.5, 0, true));
    add_block(scene, {0.2, 0.6, 0.1}, {0.4, 0.8, 0.3},
              emitting(mirror(0.75), 0.25 * emitted_by_mirrors));
    add_block(scene, {0.6, 0.6, 0.1}, {0.8, 0.8, 0.3},
              emitting(mirror(0.75, 0.7), 0.25 * emitted_by_mirrors));
    add_block(
        scene, {0.6, 0.6, 0.5}, {0.8, 0.8, 0.7},
        emitting(mirror(0.75, 0.4, 0.5, 0.5), (1 - 0.5 * 0.75 - 0.5 * 0.5) * emitted_by_mirrors));
    add_ball(scene, {0.3, 0.3, 0.7}, 0.15, 8, glass(1.33));
}

// All kinds of sources, in the open, and all that shines.
Scene garden() {
    Scene scene = room({grey(0.5), grey(0.6), grey(0.3), grey(0.5), grey(0.4, 2), grey(0.5)}, 3);
    scene.surfaces.pop_back();  // no roof
    add_shiny(scene, 0);
    scene.materials[6].specular.absorption = Spectrum::constant(2);
    add_light_and_sky(scene);
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(glm::dvec3(0.3, 0.2, -1));
    sun.half_angle = 0.02;
    sun.intensity = Spectrum::constant(1);
    scene.lights.push_back(sun);
    return scene;
}

}  // namespace

TEST_CASE("a furnace with mirrors and glass stays a furnace") {
    Scene scene = room(grey(0.5, 0.5 * everywhere), 3);
    add_shiny(scene, everywhere);
    check_furnace(scene, 1e-5);
}

TEST_CASE("a furnace in a sphere, with spheres that mirror and of glass, stays a furnace") {
    // Walls, mirrors and glass see themselves. Fails when a walk leaves out all of the surface that
    // it leaves (tests/planted/curved_skip.patch), or takes a curved surface's one normal for
    // all.
    Scene scene;
    scene.bands = 1;
    add_sphere(scene, {0, 0, 0}, 1, grey(0.5, 1), 4, 6, true);
    add_sphere(scene, {0.3, 0.2, 0.1}, 0.4, glass(1.5), 3, 4);
    add_sphere(scene, {-0.4, -0.3, 0}, 0.3, emitting(mirror(0.75), 0.5), 3, 4);
    add_sphere(scene, {0.1, -0.5, 0.5}, 0.2,
               emitting(mirror(0.75, 0, 0.5, 0.5), 2 * (1 - 0.5 * 0.75 - 0.5 * 0.5)), 2, 4);
    check_furnace(scene, 1e-4);
}

TEST_CASE("with mirrors and glass the balance closes and threads change no bit") {
    const Scene scene = garden();
    const Patches patches = make_patches(scene);
    for (FirstShot shot : {FirstShot::off, FirstShot::rays})
        for (std::uint64_t shots : {0, 4}) {
            CAPTURE(int(shot));
            CAPTURE(shots);
            SolveSettings settings;
            settings.first_shot = shot;
            settings.shots = shots;
            settings.bundles = 96;
            Solution first;
            for (unsigned threads : {1u, 2u, 3u}) {
                settings.threads = threads;
                const Solution solution = solve(scene, patches, settings);
                CHECK(solution.energy.residual[0] == 0);
                CHECK(solution.energy.absorbed[0] > 0);
                CHECK(solution.energy.escaped[0] > 0);
                if (threads == 1)
                    first = solution;
                CHECK(solution.hash == first.hash);
                CHECK(solution.energy.absorbed == first.energy.absorbed);
            }
        }
}

// Two walls that mirror all make four rooms of one: each patch has the light of its image.
TEST_CASE("a mirror box behaves as its images") {
    auto walls = [](const Material& x, const Material& y) {
        return room({grey(0.7), x, grey(0.4), y, grey(0.6), grey(0.5)}, 3);
    };
    Scene mirrors = walls(mirror(1), mirror(1));
    add_plate(mirrors, {0.2, 0.3, 0.9}, {0, 0.2, 0}, {0.3, 0, 0}, grey(0.2, 5));
    // The same room four times.
    Scene images;
    images.bands = 1;
    images.objects = {"room"};
    for (const glm::dvec2& sign :
         {glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(1, -1), glm::dvec2(-1, -1)}) {
        const auto first = static_cast<std::uint32_t>(images.positions.size());
        for (glm::dvec3 p : mirrors.positions)
            images.positions.push_back({sign.x * (p.x - 1), sign.y * (p.y - 1), p.z});
        for (Surface surface : mirrors.surfaces) {
            if (surface.material == 1 || surface.material == 3)
                continue;
            for (std::uint32_t& corner : surface.corner)
                corner += first;
            if (sign.x * sign.y < 0)  // turned inside out, u and v change places
                std::swap(surface.corner[1], surface.corner[3]);
            images.surfaces.push_back(surface);
        }
    }
    images.materials = mirrors.materials;
    const Patches own = make_patches(mirrors), all = make_patches(images);
    SolveSettings settings;
    settings.bundles = 192;
    settings.line_spacing = 0.1;
    constexpr int seeds = 32;
    const std::vector<Sample> a = over_seeds(mirrors, own, settings, seeds);
    const std::vector<Sample> b = over_seeds(images, all, settings, seeds, 1000);
    double worst = 0, largest = 0;
    std::size_t compared = 0;
    // The first image is the room itself, in the same order of surfaces, mirrors left out.
    for (std::size_t s = 0, at = 0; s < mirrors.surfaces.size(); ++s) {
        const std::uint32_t material = mirrors.surfaces[s].material;
        if (material == 1 || material == 3)
            continue;
        const SurfaceGrid &grid = own.grids[s], &image = all.grids[at++];
        for (std::uint32_t cell = 0; cell < grid.nu * grid.nv; ++cell, ++compared) {
            const Sample &x = a[grid.front + cell], &y = b[image.front + cell];
            worst = std::max(worst, std::fabs(x.mean() - y.mean()) /
                                        std::hypot(x.standard_error(), y.standard_error()));
            largest = std::max(largest, std::fabs(x.mean() / y.mean() - 1));
        }
    }
    CHECK(compared == 4 * 9 + 1);
    CHECK(worst < sidak_bound(compared, seeds));
    CHECK(largest < 0.05);
}

namespace {

// A point light a metre over the middle of a black floor; what patch `patch` gets, over seeds.
Sample floor_light(const Scene& scene, std::size_t patch, int seeds) {
    const Patches patches = make_patches(scene);
    Sample sample;
    SolveSettings settings;
    settings.bundles = 16;
    settings.first_shot_rays = 200'000;
    for (int seed = 1; seed <= seeds; ++seed) {
        settings.seed = std::uint64_t(seed);
        sample.add(solve(scene, patches, settings).irradiance[patch]);
    }
    return sample;
}

Scene lit_floor() {
    Scene scene;
    scene.bands = 1;
    add_plate(scene, {-0.05, -0.05, 0}, {0.1, 0, 0}, {0, 0.1, 0}, grey(0));
    Light light;
    light.position = {0, 0, 1};
    light.intensity = Spectrum::constant(1);
    scene.lights = {light};
    return scene;
}

}  // namespace

// H = I / d², and what the light's image at 3 m adds below a mirror, by its reflectance; what a
// sheet lets through; both of suns alike.
TEST_CASE("lights without area reach what they light by mirrors and through sheets") {
    const double alone = floor_light(lit_floor(), 0, 1).mean();
    CHECK(alone == doctest::Approx(1).epsilon(0.01));
    Scene scene = lit_floor();
    add_plate(scene, {-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}, mirror(0.8));
    Sample sample = floor_light(scene, 0, 16);
    CHECK(std::fabs(sample.z(alone + 0.8 / 9)) < sidak_bound(1, 16));
    CHECK(sample.standard_error() < 0.01);

    scene = lit_floor();
    add_plate(scene, {-0.1, -0.1, 0.5}, {0.2, 0, 0}, {0, 0.2, 0}, glass(1.5, 0, true));
    sample = floor_light(scene, 0, 16);
    CHECK(std::fabs(sample.z(alone * (1 - 0.08 / 1.04))) < sidak_bound(3, 16));
    CHECK(sample.standard_error() < 0.005);

    for (double half_angle : {0.0, sun_half_angle}) {
        CAPTURE(half_angle);
        scene.lights[0].kind = Light::Kind::directional;
        scene.lights[0].direction = {0, 0, -1};
        scene.lights[0].half_angle = half_angle;
        sample = floor_light(scene, 0, 16);
        CHECK(std::fabs(sample.z(1 - 0.08 / 1.04)) < sidak_bound(3, 16));
        CHECK(sample.standard_error() < 0.005);
    }
}

// A slab of 0.1 m, light straight through: e^(-a d), and what its faces let through, summed to and
// fro: τ T² / (1 - τ² R²).
TEST_CASE("glass absorbs by the way inside") {
    Scene scene = lit_floor();
    add_block(scene, {-0.2, -0.2, 0.3}, {0.2, 0.2, 0.4}, glass(1.5, 3));
    scene.lights[0].kind = Light::Kind::directional;
    scene.lights[0].direction = {0, 0, -1};
    const double r = 0.04, tau = std::exp(-0.3);
    const Sample sample = floor_light(scene, 0, 16);
    CHECK(std::fabs(sample.z(tau * (1 - r) * (1 - r) / (1 - tau * tau * r * r))) <
          sidak_bound(1, 16));
    CHECK(sample.standard_error() < 0.01);
}

// The sun through a ball of glass: what falls into a square about the axis, past which a sphere's
// own rays go by the law of sines.
TEST_CASE("a lens brings a caustic where geometry says") {
    constexpr double n = 1.5, radius = 0.2, below = 0.3, half = 0.03;  // focus: 1.5 radii
    Scene scene;
    scene.bands = 1;
    add_plate(scene, {-3 * half, -3 * half, 0}, {6 * half, 0, 0}, {0, 6 * half, 0}, grey(0), 3);
    SUBCASE("of facets") {
        add_ball(scene, {0, 0, below}, radius, 96, glass(n));
    }
    SUBCASE("itself") {
        add_sphere(scene, {0, 0, below}, radius, glass(n), 8, 12);
    }
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = {0, 0, -1};
    sun.intensity = Spectrum::constant(1);
    scene.lights = {sun};
    auto transmitted = [&](double sine) {
        const double a = std::asin(sine), b = std::asin(sine / n);
        const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
        return std::pow(1 - (sine < 1e-6 ? 0.04 : 0.5 * (s * s + p * p)), 2);
    };
    double inside = 0, whole = 0;
    constexpr int rings = 4000, turns = 200;
    for (int i = 0; i < rings; ++i) {
        const double sine = (i + 0.5) / rings;
        const double a = std::asin(sine), b = std::asin(sine / n), turned = 2 * (a - b);
        // Leaves the sphere at the angle 2 b - a beyond its lowest point, turned by `turned`.
        const double from = 2 * b - a;
        const double x = radius * std::sin(from), z = below - radius * std::cos(from);
        if (turned >= pi / 2)
            continue;
        const double place = std::fabs(x - z * std::tan(turned));
        const double power = transmitted(sine) * 2 * pi * radius * radius * sine / rings;
        whole += power;
        for (int k = 0; k < turns; ++k) {
            const double angle = 2 * pi * (k + 0.5) / turns;
            if (std::max(std::fabs(std::cos(angle)), std::fabs(std::sin(angle))) * place < half)
                inside += power / turns;
        }
    }
    const Sample sample = floor_light(scene, 4, 8);
    const double there = sample.mean() * 4 * half * half;
    MESSAGE("of " << whole << " W through the ball " << inside << " W by geometry, " << there
                  << " W by the solver");
    CHECK(there == doctest::Approx(inside).epsilon(0.03));
    CHECK(there > 6 * 4 * half * half);  // the sun alone
}

TEST_CASE("what knows nothing of mirrors refuses them") {
    const Scene scene = garden();
    const Patches patches = make_patches(scene);
    auto refused = [&](auto&& change) {
        SolveSettings settings;
        settings.bundles = 16;
        change(settings);
        try {
            solve(scene, patches, settings);
        } catch (const Error& error) {
            return error.fault() == Fault::usage;
        }
        return false;
    };
    CHECK(!refused([](SolveSettings&) {}));
    for (Method method : {Method::lines, Method::progressive, Method::particles, Method::matrix})
        CHECK(refused([&](SolveSettings& s) {
            s.method = method;
            s.bundles = 0;
        }));
    CHECK(refused([](SolveSettings& s) { s.direction = Direction::oriented; }));
    CHECK(refused([](SolveSettings& s) { s.first_shot = FirstShot::exact; }));
}
