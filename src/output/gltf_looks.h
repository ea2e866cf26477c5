#pragma once

#include <map>
#include <utility>

#include "output/gltf_file.h"
#include "parallux/bake.h"

namespace parallux {

/// The materials of a baked glTF, made when first asked for. Under vertex colours white, so that
/// they are what is seen, or with the scene's picture that they multiply; with a lightmap the
/// scene's own colours, pictures and emission.
class GltfLooks {
public:
    /// Keeps references to all.
    GltfLooks(const Scene& scene, const BakeSettings& settings, bool lightmap, GltfFile& gltf)
        : scene_(scene), settings_(settings), lightmap_(lightmap), gltf_(gltf) {}

    /// The index of a part's material.
    std::size_t of(const BakePart& part);

private:
    using Json = GltfFile::Json;
    struct Picture {
        std::size_t index;
        float factor;  ///< times the texture as written: the texture
    };

    Json make(const BakePart& part);
    void add_emission(const Material& material, Json& look);
    Picture picture(std::uint32_t texture);

    const Scene& scene_;
    const BakeSettings& settings_;
    bool lightmap_;
    GltfFile& gltf_;
    std::map<std::pair<std::uint32_t, bool>, std::size_t> looks_;
    std::map<std::uint32_t, Picture> pictures_;
};

}  // namespace parallux
