#pragma once

#include <string>

#include "scene/json_view.h"
#include "scene/mesh_builder.h"

namespace parallux {

// One reader a format. Each fills the builder's scene from the file's bytes; Scene::file is set.
// All throw Fault::input naming file and element.

void read_gltf(SceneBuilder& builder, std::string bytes);
void read_obj(SceneBuilder& builder, const std::string& bytes);
void read_stl(SceneBuilder& builder, const std::string& bytes);
void read_parallux(SceneBuilder& builder, const Json& json);

/// load_scene() of a file that has these bytes.
Scene scene_of(const std::filesystem::path& file, std::string bytes, const LoadSettings& settings);

bool looks_like_stl(const std::string& bytes);

/// A name that a file gives, fit for tables and messages; `otherwise` where it gives none.
std::string name_or(const std::string& name, const std::string& otherwise);

/// A new object of the scene; its index.
std::uint32_t add_object(Scene& scene, const std::string& name);
/// A new material of the scene; its index.
std::uint32_t add_material(Scene& scene, Material material);
/// The material of faces that name none.
Material default_material(const LoadSettings& settings, bool two_sided);

/// Collects what is worth one line however often it occurs.
struct Tally {
    std::uint64_t count = 0;
    std::string first;  ///< who it was first
    void note(const std::string& name) {
        if (count++ == 0)
            first = name;
    }
    /// "3 materials (first "wall") <what>", when there were any.
    void warn(Scene& scene, const std::string& noun, const std::string& what) const;
};

/// What is wrong with a material's sides: ρ + τ not below 1, or values for a back or a way through
/// without two sides; empty: nothing.
std::string side_fault(const Material& material);

/// The largest reflectance that a solve can carry: with 1 light would never end.
inline constexpr float max_reflectance = 0.999f;

}  // namespace parallux
