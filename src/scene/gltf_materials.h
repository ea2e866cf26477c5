#pragma once

#include <map>
#include <optional>

#include "scene/gltf_document.h"
#include "scene/loaders.h"
#include "scene/textures.h"

namespace parallux {

/// Where a texture's coordinates come from: an attribute set, and KHR_texture_transform.
struct UvSource {
    std::uint64_t set = 0;
    glm::vec2 offset{0}, scale{1};
    float rotation = 0;  ///< radians
    bool operator==(const UvSource&) const = default;

    glm::vec2 apply(glm::vec2 uv) const;
};

/// A glTF material in the scene. Coordinates of the base colour's texture go to uv0, those of the
/// emissive one to uv1 unless they are the same: any attribute set and transform then fits.
struct GltfMaterial {
    std::uint32_t index = 0;
    std::optional<UvSource> uv0, uv1;  ///< none: not needed
};

/// Turns a document's materials into the scene's, on demand.
class GltfMaterials {
public:
    GltfMaterials(GltfDocument& document, SceneBuilder& builder);

    /// The material of a primitive.
    const GltfMaterial& of(const JsonView& primitive);
    /// Leaves the summarising warnings.
    void finish();

private:
    GltfMaterial read(const JsonView& json, const std::string& name);
    void read_base_colour(const JsonView& json, Material& material, GltfMaterial& result);
    void read_specular(const JsonView& json, Material& material);
    void read_glass(const JsonView& json, Material& material);
    void read_diffuse_transmission(const JsonView& json, Material& material);
    void read_emission(const JsonView& json, Material& material, GltfMaterial& result);
    std::uint32_t read_texture(const JsonView& info, UvSource& source);

    GltfDocument& document_;
    SceneBuilder& builder_;
    TextureReader textures_;
    std::map<std::uint64_t, GltfMaterial> known_;  ///< by index; none: the default
    Tally metals_, plain_metals_, both_, smooth_, transparent_, white_, plain_, turned_, clamped_;
};

}  // namespace parallux
