#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "scene/loaders.h"

namespace parallux {

/// Welds corners that differ by rounding only: a corner given as origin + u + v need not have the
/// bits of the same corner given as an origin, and a closed room must be closed.
class CornerSnapper {
public:
    /// `extent`: the largest coordinate there will be; corners nearer than 10⁻¹² of it are one.
    CornerSnapper(SceneBuilder& builder, double extent);
    std::uint32_t weld(const glm::dvec3& position);

private:
    SceneBuilder& builder_;
    double tolerance_;
    std::unordered_map<std::string, std::uint32_t> cells_;  ///< by the cell's three numbers
};

/// Reads a Parallux scene; its keys are documented by scenes/parallux-scene.schema.json.
class ParalluxReader {
public:
    ParalluxReader(SceneBuilder& builder, const JsonView& root);
    void read();

private:
    // parallux_json.cpp: what the scene is made of
    Spectrum spectrum(const JsonView& json, double low, double high) const;
    void read_materials();
    void read_back(const JsonView& json, Material& m) const;
    void read_specular(const JsonView& json, Material& m) const;
    std::uint32_t material(const JsonView& json) const;
    void read_lights();
    void read_cameras();
    glm::dvec3 direction(const JsonView& json) const;

    // parallux_sky.cpp: what lies around it
    void read_sky();
    void read_period();
    bool read_drawn_sky(const JsonView& json);
    SkySettings read_sky_model(const JsonView& json) const;

    // parallux_surfaces.cpp: its geometry
    void read_surfaces();
    void read_flat(const JsonView& json, std::uint32_t object);
    void read_box(const JsonView& json, std::uint32_t object);
    void read_grid(const JsonView& json, Surface& surface) const;
    void read_mesh(const JsonView& json);
    double largest_coordinate() const;

    SceneBuilder& builder_;
    Scene& scene_;
    JsonView root_;
    double scale_;  ///< of this file's lengths; the caller's scale comes on top in the builder
    glm::dvec3 up_;
    std::map<std::string, std::uint32_t> materials_;
    std::uint32_t default_ = none;
    CornerSnapper* snapper_ = nullptr;
};

/// Appends the surfaces, materials, textures, lights and cameras of a mesh file's scene. `material`
/// other than none replaces the mesh's own.
void append_scene(SceneBuilder& builder, Scene& mesh, double scale, const glm::dvec3& translate,
                  std::uint32_t material);

}  // namespace parallux
