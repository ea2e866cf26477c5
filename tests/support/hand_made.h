#pragma once

#include <array>
#include <cmath>
#include <string>

#include "parallux/scene.h"

// Scenes made by hand, so that tests of later stages do not lean on the loaders.

namespace parallux::test {

inline Material grey(double reflectance, double emission = 0, bool two_sided = false) {
    Material material;
    material.name = "grey";
    material.reflectance = Spectrum::constant(static_cast<float>(reflectance));
    material.emission = Spectrum::constant(static_cast<float>(emission));
    material.two_sided = two_sided;
    return material;
}

/// Adds the six faces of a box as parallelograms with shared corners, n × n cells a face, in the
/// order x-, x+, y-, y+, z-, z+. Faces look inward for a room, outward for a solid. `corner` maps
/// the unit cube into space, so that solids may be turned.
template <class Map>
void add_box(Scene& scene, Map&& corner, bool inward, std::uint32_t n,
             const std::array<std::uint32_t, 6>& materials) {
    std::uint32_t first = static_cast<std::uint32_t>(scene.positions.size());
    for (int k = 0; k < 8; ++k)
        scene.positions.push_back(corner(glm::dvec3(k & 1, (k >> 1) & 1, (k >> 2) & 1)));
    // Corners counter-clockwise seen from outside.
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::uint32_t object = static_cast<std::uint32_t>(scene.objects.size());
    scene.objects.push_back("box " + std::to_string(object));
    for (int face = 0; face < 6; ++face) {
        Surface surface;
        for (int k = 0; k < 4; ++k)
            surface.corner[k] = first + faces[face][inward ? (4 - k) % 4 : k];
        surface.material = materials[face];
        surface.object = object;
        surface.grid_u = surface.grid_v = static_cast<std::uint16_t>(n);
        scene.surfaces.push_back(surface);
    }
}

/// Adds a parallelogram of one cell, of the first material and object.
inline void add_quad(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u,
                     const glm::dvec3& v) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::dvec3& p : {origin, origin + u, origin + u + v, origin + v})
        scene.positions.push_back(p);
    Surface surface;
    surface.corner = {first, first + 1, first + 2, first + 3};
    surface.grid_u = surface.grid_v = 1;
    scene.surfaces.push_back(surface);
}

/// A closed room low … high, n × n cells a face, every face of its own material.
inline Scene room(const std::array<Material, 6>& faces, std::uint32_t n,
                  glm::dvec3 low = glm::dvec3(0), glm::dvec3 high = glm::dvec3(1)) {
    Scene scene;
    scene.bands = 1;
    scene.materials.assign(faces.begin(), faces.end());
    add_box(scene, [&](glm::dvec3 p) { return low + p * (high - low); }, true, n,
            {0, 1, 2, 3, 4, 5});
    return scene;
}

/// A room of one material all over.
inline Scene room(const Material& material, std::uint32_t n, glm::dvec3 low = glm::dvec3(0),
                  glm::dvec3 high = glm::dvec3(1)) {
    return room({material, material, material, material, material, material}, n, low, high);
}

/// Puts a solid turned about an odd axis into a scene: sides of length `side` about `centre`.
inline void add_turned_cube(Scene& scene, glm::dvec3 centre, double side, std::uint32_t n,
                            const Material& material) {
    std::uint32_t m = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    // Columns of a rotation with rational entries: (2, 3, 6) / 7 and its kin.
    glm::dvec3 x = glm::dvec3(2, 3, 6) / 7.0, y = glm::dvec3(3, -6, 2) / 7.0,
               z = glm::dvec3(6, 2, -3) / 7.0;
    add_box(scene,
            [&](glm::dvec3 p) {
                p = side * (p - glm::dvec3(0.5));
                return centre + p.x * x + p.y * y + p.z * z;
            },
            false, n, {m, m, m, m, m, m});
}

/// A ball of triangles, `rings` from pole to pole and twice as many round, outward.
inline void add_ball(Scene& scene, glm::dvec3 centre, double radius, std::uint32_t rings,
                     const Material& material) {
    const std::uint32_t first = static_cast<std::uint32_t>(scene.positions.size());
    const std::uint32_t round = 2 * rings;
    Surface surface;
    surface.material = static_cast<std::uint32_t>(scene.materials.size());
    surface.object = static_cast<std::uint32_t>(scene.objects.size());
    scene.materials.push_back(material);
    scene.objects.push_back("ball");
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t k = 0; k < round; ++k) {
            const double a = pi * ring / rings, b = 2 * pi * k / round;
            scene.positions.push_back(centre + radius * glm::dvec3(std::sin(a) * std::cos(b),
                                                                   std::sin(a) * std::sin(b),
                                                                   std::cos(a)));
        }
    const std::uint32_t north = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.push_back(centre + glm::dvec3(0, 0, radius));
    scene.positions.push_back(centre - glm::dvec3(0, 0, radius));
    auto at = [&](std::uint32_t ring, std::uint32_t k) {
        return ring == 0       ? north
               : ring == rings ? north + 1
                               : first + (ring - 1) * round + k % round;
    };
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t k = 0; k < round; ++k) {
            surface.corner = {at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), none};
            if (ring + 1 < rings)
                scene.surfaces.push_back(surface);
            surface.corner = {at(ring, k), at(ring + 1, k + 1), at(ring, k + 1), none};
            if (ring > 0)
                scene.surfaces.push_back(surface);
        }
}

/// A point light within the unit cube and a uniform sky, so that a run has all kinds of sources.
inline void add_light_and_sky(Scene& scene) {
    Light light;
    light.position = {0.1, 0.2, 0.9};
    light.intensity = Spectrum::constant(0.5);
    scene.lights = {light};
    scene.sky.kind = Sky::Kind::uniform;
    scene.sky.zenith = Spectrum::constant(0.1f);
}

/// An L-shaped room of height 1: the unit squares at (0, 0), (1, 0) and (0, 1), with floors and
/// ceilings of three squares each, so that all edges are shared whole.
inline Scene l_room(const Material& wall, const Material& light, std::uint32_t n) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {wall, light};
    scene.objects = {"room"};
    constexpr double outline[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1},
                                      {1, 1}, {1, 2}, {0, 2}, {0, 1}};
    for (int z = 0; z < 2; ++z)
        for (const auto& p : outline)
            scene.positions.push_back({p[0], p[1], z});
    auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                   std::uint32_t material) {
        Surface surface;
        surface.corner = {a, b, c, d};
        surface.material = material;
        surface.grid_u = surface.grid_v = static_cast<std::uint16_t>(n);
        scene.surfaces.push_back(surface);
    };
    // Floors look up, ceilings down, walls inward: the outline runs counter-clockwise.
    constexpr std::uint32_t squares[3][4] = {{0, 1, 4, 7}, {1, 2, 3, 4}, {7, 4, 5, 6}};
    for (const auto& s : squares) {
        add(s[0], s[1], s[2], s[3], 0);
        add(s[0] + 8, s[3] + 8, s[2] + 8, s[1] + 8, 0);
    }
    for (std::uint32_t k = 0; k < 8; ++k) {
        std::uint32_t next = (k + 1) % 8;
        add(next, k, k + 8, next + 8, k == 2 ? 1u : 0u);
    }
    return scene;
}

}  // namespace parallux::test
