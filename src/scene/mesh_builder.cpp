#include "scene/mesh_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "parallux/error.h"
#include "scene/input.h"

namespace parallux {
namespace {

// Relative to the longest edge, so that a scene in millimetres loses the same faces as one in
// kilometres. Twelve digits leave a sliver of aspect 10⁶ alone, rounding noise in a line not.
bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double least = 1e-12) {
    glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
    double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    return glm::length(glm::cross(ab, ac)) > least * longest;
}

// Mesh files hold floats, and a sphere's pole made of sines is then a ring of needles some 10⁻⁸
// wide: narrower than floats resolve where they stand, so no face. Width is judged beside length,
// because far from the origin rounding alone flattens honest faces, too.
bool is_face(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    // Veltkamp's splitting rounds to a float's 24 bits. dvec3(vec3(p)) would say the same, but g++
    // 12 drops that pair of conversions at -O2.
    auto rounded = [](const glm::dvec3& p) {
        glm::dvec3 t = 536870913.0 * p;
        return t - (t - p);
    };
    return has_area(a, b, c, 2.4e-7) ||
           (has_area(a, b, c) && has_area(rounded(a), rounded(b), rounded(c), 0));
}

template <class T>
std::array<T, 3> pick(const std::vector<T>& values, const std::array<std::uint32_t, 3>& vertex) {
    return {values[vertex[0]], values[vertex[1]], values[vertex[2]]};
}

SurfaceAttributes attributes_at(const Mesh& mesh, const std::array<std::uint32_t, 3>& vertex) {
    SurfaceAttributes result;
    if (!mesh.uv0.empty())
        result.uv0 = pick(mesh.uv0, vertex);
    if (!mesh.uv1.empty())
        result.uv1 = pick(mesh.uv1, vertex);
    if (!mesh.colours.empty())
        result.colour = pick(mesh.colours, vertex);
    return result;
}

// Values at the corners p q r of one triangle and r q s of the other: equal on the shared edge and
// s = q + r - p.
template <class V>
bool affine(const std::vector<V>& values, const std::array<std::uint32_t, 3>& pqr,
            const std::array<std::uint32_t, 3>& srq) {
    if (values.empty())
        return true;
    auto near = [](const V& a, const V& b) {
        V difference = glm::abs(a - b);
        for (int i = 0; i < V::length(); ++i)
            if (!(difference[i] <= 1e-4f))
                return false;
        return true;
    };
    V p = values[pqr[0]], q = values[pqr[1]], r = values[pqr[2]];
    return near(values[srq[2]], q) && near(values[srq[1]], r) && near(values[srq[0]], q + r - p);
}

const std::array<glm::vec2, 3> no_lightmap_uv = {glm::vec2(NAN), glm::vec2(NAN), glm::vec2(NAN)};

std::array<std::uint32_t, 3> rotated(const std::array<std::uint32_t, 3>& a, std::size_t first) {
    return {a[first], a[(first + 1) % 3], a[(first + 2) % 3]};
}

}  // namespace

SceneBuilder::SceneBuilder(Scene& scene, const LoadSettings& settings)
    : scene_(scene), settings_(settings), table_(1024, none) {
}

void SceneBuilder::check(const glm::dvec3& p, const std::string& place, std::size_t index) const {
    glm::dvec3 size = glm::abs(p * settings_.scale);
    if (!(size.x <= 1e15 && size.y <= 1e15 && size.z <= 1e15))
        input_error(
            scene_.file, place,
            "position " + std::to_string(index) + " is not a number or beyond 1e15; mend the file");
}

std::size_t SceneBuilder::slot_of(const glm::dvec3& p) const {
    auto mix = [](std::uint64_t h, double x) {
        h ^= std::bit_cast<std::uint64_t>(x);
        h *= 0xFF51AFD7ED558CCDu;
        return h ^ h >> 32;
    };
    std::uint64_t h = mix(mix(mix(0x9E3779B97F4A7C15u, p.x), p.y), p.z);
    std::size_t mask = table_.size() - 1, slot = h & mask;
    while (table_[slot] != none && scene_.positions[table_[slot]] != p)
        slot = (slot + 1) & mask;
    return slot;
}

void SceneBuilder::grow_table() {
    table_.assign(table_.size() * 2, none);
    for (std::uint32_t i = 0; i < scene_.positions.size(); ++i)
        table_[slot_of(scene_.positions[i])] = i;
}

std::uint32_t SceneBuilder::weld(const glm::dvec3& position) {
    glm::dvec3 p = position * settings_.scale + 0.0;  // + 0.0 makes -0 and 0 one position
    std::size_t slot = slot_of(p);
    if (table_[slot] != none)
        return table_[slot];
    if (2 * (scene_.positions.size() + 1) > table_.size()) {
        grow_table();
        slot = slot_of(p);
    }
    table_[slot] = static_cast<std::uint32_t>(scene_.positions.size());
    scene_.positions.push_back(p);
    return table_[slot];
}

void SceneBuilder::store(const Surface& surface, const SurfaceAttributes* attributes) {
    if (attributes != nullptr && scene_.attributes.empty())
        scene_.attributes.resize(scene_.surfaces.size());
    scene_.surfaces.push_back(surface);
    if (attributes != nullptr)
        scene_.attributes.push_back(*attributes);
    else if (!scene_.attributes.empty())
        scene_.attributes.emplace_back();
}

bool SceneBuilder::add(const Surface& surface) {
    const auto& p = scene_.positions;
    if (surface.is_curved()) {
        store(surface, nullptr);
        return true;
    }
    scene_.triangles += surface.shape() == Shape::triangle ? 1 : 2;
    if (!has_area(p[surface.corner[0]], p[surface.corner[1]], p[surface.corner_v()])) {
        scene_.zero_area += surface.shape() == Shape::triangle ? 1 : 2;
        return false;
    }
    store(surface, nullptr);
    return true;
}

std::vector<MeshTriangle> SceneBuilder::keep_triangles_with_area(const Mesh& mesh) {
    std::vector<std::uint32_t> welded(mesh.positions.size(), none);
    std::vector<MeshTriangle> triangles;
    triangles.reserve(mesh.indices.size() / 3);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        MeshTriangle t;
        std::copy_n(mesh.indices.begin() + static_cast<std::ptrdiff_t>(i), 3, t.vertex.begin());
        auto [a, b, c] = pick(mesh.positions, t.vertex);
        if (!is_face(a, b, c)) {
            ++scene_.zero_area;
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& w = welded[t.vertex[k]];
            if (w == none)
                w = weld(mesh.positions[t.vertex[k]]);
            t.corner[k] = w;
        }
        triangles.push_back(t);
    }
    return triangles;
}

void SceneBuilder::add(const Mesh& mesh) {
    scene_.triangles += mesh.indices.size() / 3;
    if (scene_.triangles > max_triangles)
        input_error(scene_.file, mesh.place,
                    "more than " + std::to_string(max_triangles) +
                        " triangles with all instances; simplify the scene");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        check(mesh.positions[i], mesh.place, i);

    std::vector<MeshTriangle> triangles = keep_triangles_with_area(mesh);
    std::vector<Partner> partners(triangles.size());
    if (!settings_.keep_triangles)
        partners = find_parallelograms(
            scene_.positions, triangles,
            [&](const MeshTriangle& a, int apex, const MeshTriangle& b, int other_apex) {
                auto pqr = rotated(a.vertex, apex), srq = rotated(b.vertex, other_apex);
                return affine(mesh.uv0, pqr, srq) && affine(mesh.uv1, pqr, srq) &&
                       affine(mesh.lightmap_uv, pqr, srq) && affine(mesh.colours, pqr, srq);
            });
    scene_.surfaces.reserve(scene_.surfaces.size() + triangles.size() / 2);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        if (partners[t].triangle > t)  // none, or the second of a pair: the first one stores it
            add_pair(mesh, triangles[t], partners[t], triangles);
}

void SceneBuilder::add_pair(const Mesh& mesh, const MeshTriangle& triangle, const Partner& partner,
                            const std::vector<MeshTriangle>& triangles) {
    auto corner = rotated(triangle.corner, partner.apex);
    Surface surface;
    surface.corner = {corner[0], corner[1], corner[2], none};
    if (partner.triangle != none) {
        std::uint32_t fourth = triangles[partner.triangle].corner[partner.other_apex];
        surface.corner = {corner[0], corner[1], fourth, corner[2]};
    }
    surface.material = mesh.material;
    surface.object = mesh.object;
    if (settings_.lightmap_uv) {
        scene_.lightmap_uv.resize(scene_.surfaces.size(), no_lightmap_uv);
        scene_.lightmap_uv.push_back(
            mesh.lightmap_uv.empty()
                ? no_lightmap_uv
                : pick(mesh.lightmap_uv, rotated(triangle.vertex, partner.apex)));
    }
    if (mesh.uv0.empty() && mesh.uv1.empty() && mesh.colours.empty())
        return store(surface, nullptr);
    SurfaceAttributes attributes = attributes_at(mesh, rotated(triangle.vertex, partner.apex));
    store(surface, &attributes);
}

}  // namespace parallux
