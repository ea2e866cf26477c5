#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "parallux/scene.h"
#include "scene/parallelograms.h"

namespace parallux {

/// The most triangles a scene may have; instances multiply quickly in a hostile file.
inline constexpr std::uint64_t max_triangles = std::uint64_t(1) << 26;

/// Triangles of one object and material, as every mesh format boils down to.
struct Mesh {
    std::string place;  ///< for messages: where in the file it stands
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> indices;  ///< three a triangle; checked by whoever fills them
    std::vector<glm::vec2> uv0, uv1;     ///< empty, or one a position
    std::vector<glm::vec2> lightmap_uv;  ///< empty, or one a position
    std::vector<glm::vec3> colours;      ///< empty, or one a position
    std::uint32_t material = 0;
    std::uint32_t object = 0;
};

/// Turns meshes and single surfaces into a scene's surfaces: welds equal positions, drops and
/// counts faces without area, joins triangle pairs to parallelograms.
class SceneBuilder {
public:
    SceneBuilder(Scene& scene, const LoadSettings& settings);

    /// Index of a position of the file after scaling; equal positions have one index.
    std::uint32_t weld(const glm::dvec3& position);
    void add(const Mesh& mesh);
    /// A surface whose corners weld() gave; false, and counted, where it has no area.
    bool add(const Surface& surface);

    Scene& scene() { return scene_; }
    const LoadSettings& settings() const { return settings_; }
    /// Throws Fault::input where a coordinate is no number or beyond 10¹⁵.
    void check(const glm::dvec3& position, const std::string& place, std::size_t index) const;

private:
    std::vector<MeshTriangle> keep_triangles_with_area(const Mesh& mesh);
    void add_pair(const Mesh& mesh, const MeshTriangle& triangle, const Partner& partner,
                  const std::vector<MeshTriangle>& triangles);
    void store(const Surface& surface, const SurfaceAttributes* attributes);
    void grow_table();
    std::size_t slot_of(const glm::dvec3& position) const;

    Scene& scene_;
    LoadSettings settings_;
    std::vector<std::uint32_t> table_;  ///< open addressing over scene_.positions
};

/// Cuts a simple, nearly planar polygon into triangles by its ears; `corners` index `positions`.
/// Appends three indices a triangle. Linear for convex polygons, at worst cubic; so at most 1024
/// corners, longer ones are cut as a fan.
void triangulate(const std::vector<glm::dvec3>& positions,
                 const std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& indices);

}  // namespace parallux
