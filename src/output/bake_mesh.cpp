#include "output/bake_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace parallux {

namespace {

constexpr double crease = 0.35;  // radians; as pictures have it

// All that must be equal, to the bit, for two corners to share a vertex.
struct Key {
    std::array<std::uint32_t, 12> bits{};
    bool operator==(const Key&) const = default;
};

struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::uint64_t h = 0x9E3779B97F4A7C15u;
        for (std::uint32_t word : key.bits) {
            h = (h ^ word) * 0xFF51AFD7ED558CCDu;
            h ^= h >> 32;
        }
        return h;
    }
};

Key key_of(const BakeCorner& c) {
    const glm::vec3 p(c.position);
    const float values[12] = {p.x,     p.y,     p.z,     c.colour.x, c.colour.y, c.colour.z,
                              c.uv0.x, c.uv0.y, c.uv1.x, c.uv1.y,    c.uv2.x,    c.uv2.y};
    Key key;
    for (std::size_t i = 0; i < key.bits.size(); ++i)
        key.bits[i] = std::bit_cast<std::uint32_t>(values[i] + 0.0f);  // -0 and 0 are one place
    return key;
}

template <class T>
T affine_at(const std::array<T, 3>& values, const glm::dvec2& uv) {
    return values[0] + static_cast<float>(uv.x) * (values[1] - values[0]) +
           static_cast<float>(uv.y) * (values[2] - values[0]);
}

}  // namespace

struct BakeBuilder::Part {
    struct Vertex {
        BakeCorner corner;     // normal: of the first face
        glm::dvec3 normal{0};  // sum over the faces, by area
        std::uint32_t next;    // with the same key, but beyond a crease
    };
    BakePart part;
    std::vector<Vertex> vertices;
    std::unordered_map<Key, std::uint32_t, KeyHash> known;

    std::uint32_t vertex(const BakeCorner& corner, double area) {
        auto [entry, is_new] = known.try_emplace(key_of(corner), none);
        for (std::uint32_t v = entry->second; v != none; v = vertices[v].next)
            if (glm::dot(vertices[v].corner.normal, corner.normal) > std::cos(crease)) {
                vertices[v].normal += area * corner.normal;
                return v;
            }
        vertices.push_back({corner, area * corner.normal, entry->second});
        return entry->second = static_cast<std::uint32_t>(vertices.size() - 1);
    }
};

BakeBuilder::BakeBuilder(Bake& bake) : bake_(bake) {
}
BakeBuilder::~BakeBuilder() = default;

BakeBuilder::Part& BakeBuilder::part_of(const BakeFace& face) {
    auto same = [&](const Part& p) {
        return p.part.object == face.object && p.part.material == face.material &&
               p.part.both_sides == face.both_sides;
    };
    // Faces come object by object: the one wanted is among the last.
    auto found = std::find_if(parts_.rbegin(), parts_.rend(), same);
    if (found != parts_.rend())
        return *found;
    parts_.emplace_back();
    parts_.back().part.object = face.object;
    parts_.back().part.material = face.material;
    parts_.back().part.both_sides = face.both_sides;
    return parts_.back();
}

void BakeBuilder::add(const BakeFace& face) {
    Part& part = part_of(face);
    const auto& c = face.corner;
    const double area = glm::length(
        glm::cross(c[1].position - c[0].position, c[face.count - 1].position - c[0].position));
    std::array<std::uint32_t, 4> v{};
    for (std::uint32_t k = 0; k < face.count; ++k)
        v[k] = part.vertex(c[k], area);
    if (face.count == 3)
        part.part.indices.insert(part.part.indices.end(), {v[0], v[1], v[2]});
    else
        part.part.indices.insert(part.part.indices.end(), {v[0], v[1], v[3], v[3], v[1], v[2]});
}

void BakeBuilder::finish() {
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
        return std::tuple(a.part.object, a.part.material, a.part.both_sides) <
               std::tuple(b.part.object, b.part.material, b.part.both_sides);
    });
    for (Part& part : parts_) {
        part.part.first_vertex = static_cast<std::uint32_t>(bake_.positions.size());
        part.part.vertices = static_cast<std::uint32_t>(part.vertices.size());
        for (const Part::Vertex& v : part.vertices) {
            bake_.positions.emplace_back(v.corner.position);
            bake_.normals.emplace_back(glm::normalize(v.normal));
            bake_.colours.push_back(v.corner.colour);
            bake_.uv0.push_back(v.corner.uv0);
            bake_.uv1.push_back(v.corner.uv1);
            bake_.uv2.push_back(v.corner.uv2);
        }
        bake_.parts.push_back(std::move(part.part));
    }
}

FaceFrame face_frame(const Scene& scene, const Patches& patches, std::uint32_t s, bool back,
                     std::uint32_t cell) {
    const Surface& surface = scene.surfaces[s];
    const CellCorners corners = cell_corners(
        surface.shape(), cell == none ? SurfaceGrid{} : patches.grids[s], cell == none ? 0 : cell);
    FaceFrame frame;
    frame.face.object = scene.objects.empty() ? none : surface.object;
    frame.face.material = surface.material;
    frame.face.count = corners.count;
    const glm::dvec3 normal = surface_normal(scene, surface) * (back ? -1.0 : 1.0);
    for (std::uint32_t k = 0; k < corners.count; ++k) {
        // 0, last … 1: turned round the first corner, so that a quad keeps its diagonal.
        const glm::dvec2 uv = corners.uv[back ? (corners.count - k) % corners.count : k];
        BakeCorner& corner = frame.face.corner[k];
        // Corners as the file has them: the fourth one is only nearly where the axes put it.
        const bool far = uv.x == 1 && uv.y == 1 && surface.shape() == Shape::parallelogram &&
                         !surface.is_curved();
        corner.position =
            far ? scene.positions[surface.corner[2]] : surface_point(scene, surface, uv.x, uv.y);
        corner.normal = surface.is_curved()
                            ? surface_normal(scene, surface, uv.x, uv.y) * (back ? -1.0 : 1.0)
                            : normal;
        if (!scene.attributes.empty())
            corner.uv0 = affine_at(scene.attributes[s].uv0, uv);
        frame.uv[k] = uv;
    }
    return frame;
}

FaceFrame scene_frame(const Scene& scene, const Patches& patches, std::uint32_t surface,
                      bool back) {
    FaceFrame frame = face_frame(scene, patches, surface, back, none);
    for (std::uint32_t k = 0; k < frame.face.count; ++k) {
        BakeCorner& corner = frame.face.corner[k];
        corner.colour = glm::vec3(1);
        if (scene.attributes.empty())
            continue;
        const SurfaceAttributes& own = scene.attributes[surface];
        corner.uv2 = affine_at(own.uv1, frame.uv[k]);
        corner.colour = glm::clamp(affine_at(own.colour, frame.uv[k]), 0.0f, 1.0f);
    }
    return frame;
}

void drop_unused(const Scene& scene, Bake& mesh) {
    auto white = [](const glm::vec3& colour) { return colour == glm::vec3(1); };
    if (std::all_of(mesh.colours.begin(), mesh.colours.end(), white))
        mesh.colours.clear();
    if (scene.attributes.empty())
        mesh.uv0.clear();
    auto second = [](const Material& m) {
        return (m.reflectance_texture != none && m.reflectance_uv == 1) ||
               (m.emission_texture != none && m.emission_uv == 1);
    };
    if (!std::any_of(scene.materials.begin(), scene.materials.end(), second))
        mesh.uv2.clear();
}

}  // namespace parallux
