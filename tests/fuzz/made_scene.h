#pragma once

#include <array>

#include <glm/geometric.hpp>

#include "fuzz.h"
#include "parallux/lines.h"
#include "parallux/scene.h"
#include "support/hand_made.h"

// Small scenes and lines through them, made of the input's bytes.

namespace parallux::fuzz {

/// A point on a coarse lattice, so that coplanar faces, shared edges and slivers are common, or
/// anywhere.
inline glm::dvec3 point(Bytes& bytes, bool coarse) {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k)
        p[k] = coarse ? bytes.below(5) / 4.0 : bytes.real(0, 1);
    return p;
}

/// A solid tetrahedron, faces outward; nothing where its corners lie in a plane.
inline void add_tetrahedron(Scene& scene, std::array<glm::dvec3, 4> p) {
    const double volume = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    if (std::abs(volume) < 1e-6)
        return;
    if (volume < 0)
        std::swap(p[1], p[2]);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), p.begin(), p.end());
    constexpr std::uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (const auto& f : faces) {
        Surface surface;
        surface.corner = {first + f[0], first + f[1], first + f[2], none};
        surface.grid_u = surface.grid_v = 1;
        scene.surfaces.push_back(surface);
    }
}

/// Adds a solid box with sides along u, v, w, faces outward.
inline void add_solid(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u,
                      const glm::dvec3& v, const glm::dvec3& w) {
    const double volume = glm::dot(glm::cross(u, v), w);
    if (std::abs(volume) < 1e-6)
        return;
    test::add_box(scene, [&](glm::dvec3 p) { return origin + p.x * u + p.y * v + p.z * w; },
                  volume < 0, 1, {0, 0, 0, 0, 0, 0});
}

/// Closed solids alone, which may cut and touch each other.
inline Scene solids(Bytes& bytes) {
    Scene scene;
    scene.bands = 1;
    scene.materials = {test::grey(0.5, 1)};
    scene.objects = {"solids"};
    for (unsigned n = 1 + bytes.below(6); n > 0; --n) {
        const unsigned kind = bytes.below(4);
        const bool coarse = kind & 1;
        // One after the other: in which order arguments are made is the compiler's choice.
        std::array<glm::dvec3, 4> p;
        for (glm::dvec3& corner : p)
            corner = point(bytes, coarse);
        if (kind < 2)
            add_tetrahedron(scene, p);
        else
            add_solid(scene, p[0], p[1] - 0.5, p[2] - 0.5, p[3] - 0.5);
    }
    return scene;
}

/// Loose triangles and parallelograms, of one side or two.
inline void add_sheets(Scene& scene, Bytes& bytes, unsigned count) {
    scene.materials.push_back(test::grey(0.5, 1, true));
    for (; count > 0; --count) {
        const unsigned kind = bytes.below(8);
        const bool coarse = kind & 1;
        const glm::dvec3 a = point(bytes, coarse), u = point(bytes, coarse) - 0.5,
                         v = point(bytes, coarse) - 0.5;
        if (glm::length(glm::cross(u, v)) < 1e-6)
            continue;
        test::add_quad(scene, a, u, v);
        Surface& surface = scene.surfaces.back();
        if (kind & 2)
            surface.corner = {surface.corner[0], surface.corner[1], surface.corner[3], none};
        if (kind & 4)
            surface.material = 1;
    }
}

/// Along an axis or a diagonal, or anywhere; lattices that meet corners, or not.
inline Bundle bundle(Bytes& bytes, double spacing) {
    const std::uint64_t seed = bytes.word();
    Bundle lines = make_bundle({seed, 64, DirectionSet::random, spacing}, bytes.below(64));
    const unsigned kind = bytes.below(4);
    if (kind == 0) {
        const glm::dvec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const unsigned k = bytes.below(3);
        lines.direction = axes[k], lines.x = axes[(k + 1) % 3], lines.y = axes[(k + 2) % 3];
    } else if (kind == 1) {
        const double y = bytes.below(3) - 1.0, z = bytes.below(3) - 1.0;
        lines.direction = glm::normalize(glm::dvec3(1, y, z));
        const glm::dvec3 side = lines.direction.y == 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        lines.x = glm::normalize(glm::cross(side, lines.direction));
        lines.y = glm::cross(lines.direction, lines.x);
    }
    if (kind < 2 && bytes.below(2) == 0)
        lines.offset_x = lines.offset_y = 0;
    return lines;
}

}  // namespace parallux::fuzz
