#include "throughput/room.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>

#include <glm/geometric.hpp>

namespace parallux::throughput {

namespace {

using Place = std::function<glm::dvec3(const glm::dvec3&)>;

void add_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                  std::uint32_t material, bool inward) {
    Surface surface;
    surface.corner = {a, inward ? c : b, inward ? b : c, none};
    surface.material = material;
    surface.object = static_cast<std::uint32_t>(scene.objects.size() - 1);
    scene.surfaces.push_back(surface);
}

// The surface of the cube [-1, 1]³ in 12 n² triangles, each corner moved by `place`. Corners are
// known by their whole-numbered place on the cube, so that neighbours share them.
void add_cube(Scene& scene, const char* name, int n, bool inward, const Place& place,
              const std::function<std::uint32_t(const glm::dvec3&)>& material) {
    scene.objects.push_back(name);
    std::map<std::array<int, 3>, std::uint32_t> known;
    auto on_cube = [&](const std::array<int, 3>& at) {
        return glm::dvec3(2. * at[0] / n - 1, 2. * at[1] / n - 1, 2. * at[2] / n - 1);
    };
    auto corner = [&](const std::array<int, 3>& at) {
        auto [entry, fresh] =
            known.try_emplace(at, static_cast<std::uint32_t>(scene.positions.size()));
        if (fresh)
            scene.positions.push_back(place(on_cube(at)));
        return entry->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    auto at = [&](int u, int v) {
                        std::array<int, 3> p{};
                        p[axis] = side * n;
                        // Counter-clockwise from outside on either side of the axis.
                        p[(axis + 1) % 3] = side ? u : v;
                        p[(axis + 2) % 3] = side ? v : u;
                        return p;
                    };
                    std::uint32_t a = corner(at(i, j)), b = corner(at(i + 1, j));
                    std::uint32_t c = corner(at(i + 1, j + 1)), d = corner(at(i, j + 1));
                    std::uint32_t m = material(on_cube(at(i, j)));
                    add_triangle(scene, a, b, c, m, inward);
                    add_triangle(scene, a, c, d, m, inward);
                }
}

void add_ring(Scene& scene, const glm::dvec3& centre, double radius, double thickness, int around,
              int across, std::uint32_t material) {
    scene.objects.push_back("ring");
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            double a = 2 * pi * i / around, b = 2 * pi * j / across;
            double r = radius + thickness * std::cos(b);
            scene.positions.push_back(
                centre + glm::dvec3(r * std::cos(a), r * std::sin(a), thickness * std::sin(b)));
        }
    auto corner = [&](int i, int j) {
        return first + static_cast<std::uint32_t>(i % around * across + j % across);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            std::uint32_t a = corner(i, j), b = corner(i + 1, j);
            std::uint32_t c = corner(i + 1, j + 1), d = corner(i, j + 1);
            add_triangle(scene, a, b, c, material, false);
            add_triangle(scene, a, c, d, material, false);
        }
}

// A wall's bump, 3 cm at most: it ends in nothing at the wall's edges, where its neighbour begins.
glm::dvec3 bumped(const glm::dvec3& on_cube) {
    glm::dvec3 wall(0);
    for (int axis = 0; axis < 3; ++axis)
        if (std::fabs(on_cube[axis]) == 1) {
            double u = on_cube[(axis + 1) % 3], v = on_cube[(axis + 2) % 3];
            double fade = (1 - u * u) * (1 - v * v);
            double wave = std::sin(9.1 * u + 2.3 * v) * std::cos(7.7 * v - 1.9 * u);
            wall[axis] -= on_cube[axis] * 0.015 * fade * (1 + wave);
        }
    return glm::dvec3(3, 2, 1.5) * on_cube + wall;
}

Material paint(const char* name, const std::array<float, 3>& reflectance, float emission) {
    Material material;
    material.name = name;
    for (std::uint32_t band = 0; band < 3; ++band) {
        material.reflectance[band] = reflectance[band];
        material.emission[band] = emission;
    }
    return material;
}

}  // namespace

Scene make_room(double fineness) {
    auto steps = [&](int full) { return static_cast<int>(std::lround(full * fineness)); };
    Scene scene;
    scene.file = "room";
    scene.materials = {paint("wall", {0.7f, 0.68f, 0.6f}, 0), paint("light", {0.5f, 0.5f, 0.5f}, 9),
                       paint("ball", {0.6f, 0.3f, 0.2f}, 0), paint("ring", {0.2f, 0.4f, 0.6f}, 0)};
    add_cube(scene, "walls", steps(140), true, bumped, [](const glm::dvec3& at) {
        return at.z == 1 && std::fabs(at.x) < 0.3 && std::fabs(at.y) < 0.3 ? 1u : 0u;
    });
    auto ball = [&](const glm::dvec3& centre, double radius, int n) {
        add_cube(
            scene, "ball", steps(n), false,
            [=](const glm::dvec3& at) { return centre + radius * glm::normalize(at); },
            [](const glm::dvec3&) { return 2u; });
    };
    ball({-1.7, -0.6, -0.8}, 0.6, 40);
    ball({0.9, 1.1, -0.9}, 0.5, 32);
    ball({1.9, -0.9, 0.4}, 0.45, 28);
    add_ring(scene, {-0.3, 0.2, 0.5}, 0.8, 0.25, steps(150), steps(80), 3);
    scene.triangles = scene.surfaces.size();
    return scene;
}

}  // namespace parallux::throughput
