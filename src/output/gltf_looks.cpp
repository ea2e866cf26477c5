#include "output/gltf_looks.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "output/bake_values.h"
#include "output/encode.h"
#include "output/tone.h"
#include "parallux/error.h"

namespace parallux {

namespace {

// glTF knows PNG and JPEG alone: whole levels of sRGB, up to 1. `most` becomes white.
std::vector<unsigned char> png_of(const Texture& texture, float most) {
    Image image;
    image.spec = OIIO::ImageSpec(static_cast<int>(texture.width), static_cast<int>(texture.height),
                                 3, OIIO::TypeDesc::UINT8);
    image.spec.attribute("oiio:ColorSpace", "sRGB");
    image.encoded.reserve(3 * texture.texels.size());
    for (const glm::vec3& texel : texture.texels)
        for (int c = 0; c < 3; ++c)
            image.encoded.push_back(
                static_cast<std::uint8_t>(std::lround(255 * encode_srgb(texel[c] / most))));
    try {
        return encode(".png", image);
    } catch (const std::exception& failure) {
        throw Error(Fault::output,
                    "texture " + texture.name + ": cannot be written: " + failure.what());
    }
}

}  // namespace

std::size_t GltfLooks::of(const BakePart& part) {
    const auto key = std::pair(part.material, part.both_sides);
    auto known = looks_.find(key);
    if (known == looks_.end())
        known = looks_.emplace(key, gltf_.add("materials", make(part))).first;
    return known->second;
}

GltfLooks::Json GltfLooks::make(const BakePart& part) {
    const Material& m = scene_.materials[part.material];
    const bool textured = lightmap_ ? scene_.bands == 3 && m.reflectance_texture != none
                                    : keeps_picture(scene_, settings_, part.material);
    glm::vec3 base(1);
    const bool metal = lightmap_ && m.specular.kind == Specular::Kind::mirror;
    if (metal)
        base = glm::clamp(colour_of(m.specular.colour.value.data(), scene_.bands), 0.0f, 1.0f);
    else if (lightmap_)
        base = glm::clamp(colour_of(m.reflectance.value.data(), scene_.bands), 0.0f, 1.0f);
    Json pbr = {{"baseColorFactor", {base.x, base.y, base.z, 1}}};
    if (textured)
        pbr["baseColorTexture"] = {{"index", picture(m.reflectance_texture).index},
                                   {"texCoord", m.reflectance_uv == 0 ? 0 : 2}};
    pbr["metallicFactor"] = metal ? m.specular.share : 0;
    pbr["roughnessFactor"] = metal ? m.specular.roughness : 1;
    Json look = {{"name", m.name}, {"pbrMetallicRoughness", pbr}, {"doubleSided", part.both_sides}};
    if (lightmap_)
        add_emission(m, look);
    if (settings_.unlit && !lightmap_) {
        gltf_.use("KHR_materials_unlit");
        look["extensions"]["KHR_materials_unlit"] = Json::object();
    }
    return look;
}

// glTF's emission is radiance, E / π: a factor of at most 1, and a strength.
void GltfLooks::add_emission(const Material& m, Json& look) {
    glm::vec3 e = colour_of(m.emission.value.data(), scene_.bands) / float(pi);
    if (scene_.bands == 3 && m.emission_texture != none) {
        const Picture shown = picture(m.emission_texture);
        e *= shown.factor;
        look["emissiveTexture"] = {{"index", shown.index},
                                   {"texCoord", m.emission_uv == 0 ? 0 : 2}};
    }
    const float most = std::max({e.x, e.y, e.z});
    if (!(most > 0))
        return;
    const float strength = std::max(most, 1.0f);
    const glm::vec3 factor = glm::min(e / strength, 1.0f);
    look["emissiveFactor"] = {factor.x, factor.y, factor.z};
    if (strength > 1) {
        gltf_.use("KHR_materials_emissive_strength");
        look["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    }
}

GltfLooks::Picture GltfLooks::picture(std::uint32_t index) {
    if (auto known = pictures_.find(index); known != pictures_.end())
        return known->second;
    const Texture& texture = scene_.textures[index];
    float most = 1;
    for (const glm::vec3& texel : texture.texels)
        most = std::max({most, texel.x, texel.y, texel.z});
    const std::vector<unsigned char> png = png_of(texture, most);
    const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
    return pictures_[index] = {gltf_.add_picture(texture.name, bytes), most};
}

}  // namespace parallux
