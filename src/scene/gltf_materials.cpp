#include "scene/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "scene/input.h"

namespace parallux {
namespace {

std::optional<JsonView> extension(const JsonView& json, const char* name) {
    auto all = json.find("extensions");
    return all ? all->find(name) : std::nullopt;
}

glm::vec2 vec2_or(const JsonView& json, const char* key, glm::vec2 otherwise) {
    auto found = json.find(key);
    if (!found)
        return otherwise;
    if (found->size() != 2)
        found->fail("must have two numbers");
    return {found->at(std::size_t(0)).number(-1e6, 1e6), found->at(1).number(-1e6, 1e6)};
}

}  // namespace

glm::vec2 UvSource::apply(glm::vec2 uv) const {
    uv *= scale;
    float c = std::cos(rotation), s = std::sin(rotation);
    return offset + glm::vec2(c * uv.x + s * uv.y, c * uv.y - s * uv.x);
}

GltfMaterials::GltfMaterials(GltfDocument& document, SceneBuilder& builder)
    : document_(document), builder_(builder), textures_(builder.scene()) {
}

const GltfMaterial& GltfMaterials::of(const JsonView& primitive) {
    auto reference = primitive.find("material");
    if (!reference) {
        auto [entry, is_new] = known_.try_emplace(none);
        if (is_new)
            entry->second.index =
                add_material(builder_.scene(), default_material(builder_.settings(), false));
        return entry->second;
    }
    JsonView json = document_.element("materials", *reference);
    std::uint64_t index = reference->count(none);
    if (auto found = known_.find(index); found != known_.end())
        return found->second;
    std::string name = name_or(json.text_or("name", ""), "material " + std::to_string(index));
    return known_[index] = read(json, name);
}

GltfMaterial GltfMaterials::read(const JsonView& json, const std::string& name) {
    GltfMaterial result;
    Material material;
    material.name = name;
    material.two_sided = json.boolean_or("doubleSided", false);
    read_base_colour(json, material, result);
    read_emission(json, material, result);
    read_diffuse_transmission(json, material);
    read_specular(json, material);
    result.index = add_material(builder_.scene(), std::move(material));
    return result;
}

void GltfMaterials::read_base_colour(const JsonView& json, Material& material,
                                     GltfMaterial& result) {
    double factor[4] = {1, 1, 1, 1};
    if (auto pbr = json.find("pbrMetallicRoughness")) {
        if (auto colour = pbr->find("baseColorFactor")) {
            if (colour->size() != 4)
                colour->fail("must have four numbers");
            for (std::size_t c = 0; c < 4; ++c)
                factor[c] = colour->at(c).number(0, 1 + 1e-6);
        }
        if (auto texture = pbr->find("baseColorTexture")) {
            UvSource source;
            material.reflectance_texture = read_texture(*texture, source);
            if (material.reflectance_texture != none)
                result.uv0 = source;
        }
    }
    bool white = false;
    for (std::size_t c = 0; c < 3; ++c) {
        white = white || factor[c] > max_reflectance;
        material.reflectance[c] = std::min(static_cast<float>(factor[c]), max_reflectance);
    }
    if (white && material.reflectance_texture == none)
        white_.note(material.name);
    if (json.text_or("alphaMode", "OPAQUE") != "OPAQUE" && factor[3] < 0.5)
        transparent_.note(material.name);
}

// Metals mirror, by Schlick's law from the base colour to white; what is transmitted goes through
// glass: a body where there is a volume, else a thin sheet. What is left is diffuse; the coat that
// glTF has on everything else is left out. A material that has no pbrMetallicRoughness says
// nothing of metal either, though glTF's default is one.
void GltfMaterials::read_specular(const JsonView& json, Material& material) {
    double metallic = 0, roughness = 1, transmission = 0;
    if (auto pbr = json.find("pbrMetallicRoughness")) {
        metallic = pbr->has("metallicFactor") ? pbr->at("metallicFactor").number(0, 1) : 1;
        if (pbr->has("roughnessFactor"))
            roughness = pbr->at("roughnessFactor").number(0, 1);
        if (metallic > 0 && pbr->has("metallicRoughnessTexture"))
            plain_metals_.note(material.name);
    } else {
        metals_.note(material.name);
    }
    const auto through = extension(json, "KHR_materials_transmission");
    if (through && through->has("transmissionFactor"))
        transmission = through->at("transmissionFactor").number(0, 1) * (1 - metallic);
    if (through && through->has("transmissionTexture"))
        plain_.note(material.name);
    Specular& s = material.specular;
    if (metallic <= 0 && transmission <= 0)
        return;
    s.colour = material.reflectance;
    const bool mirror = metallic >= transmission;
    s.kind = mirror ? Specular::Kind::mirror : Specular::Kind::glass;
    s.share = static_cast<float>(mirror ? metallic : transmission);
    if (mirror) {
        s.grazing = Spectrum::constant(1);
        s.roughness = static_cast<float>(roughness);
        if (transmission > 0)
            both_.note(material.name);
    } else {
        read_glass(json, material);
        if (roughness > 0)
            smooth_.note(material.name);
    }
    if (s.share == 1)
        material.reflectance = material.transmittance = {};
}

void GltfMaterials::read_glass(const JsonView& json, Material& material) {
    Specular& s = material.specular;
    if (auto index = extension(json, "KHR_materials_ior"); index && index->has("ior"))
        s.ior = index->at("ior").number(1, 4);
    s.thin = true;
    auto volume = extension(json, "KHR_materials_volume");
    if (volume && volume->has("thicknessFactor"))
        s.thin = !(volume->at("thicknessFactor").number(0, 1e15) > 0);
    if (!s.thin && volume->has("attenuationDistance")) {
        const double distance =
            volume->at("attenuationDistance").number(1e-15, 1e15) * builder_.settings().scale;
        auto colour = volume->find("attenuationColor");
        if (colour && colour->size() != 3)
            colour->fail("must have three numbers");
        for (std::size_t c = 0; colour && c < 3; ++c)
            s.absorption[c] = static_cast<float>(
                std::min(1e15, -std::log(std::max(1e-30, colour->at(c).number(0, 1))) / distance));
    }
    // Light meets it from both sides, whatever the file says of seeing it from behind.
    material.two_sided = true;
}

// Of light, the share f is let through, τ = f · colour, and the rest meets the base colour: ρ =
// (1 - f) · base.
void GltfMaterials::read_diffuse_transmission(const JsonView& json, Material& material) {
    auto through = extension(json, "KHR_materials_diffuse_transmission");
    if (!through)
        return;
    double share = 0;
    if (auto factor = through->find("diffuseTransmissionFactor"))
        share = factor->number(0, 1);
    auto colour = through->find("diffuseTransmissionColorFactor");
    if (colour && colour->size() != 3)
        colour->fail("must have three numbers");
    for (std::size_t c = 0; c < 3; ++c) {
        const double tau = share * (colour ? colour->at(c).number(0, 1) : 1.0);
        material.transmittance[c] = std::min(static_cast<float>(tau), max_reflectance);
        material.reflectance[c] =
            std::min(static_cast<float>((1 - share) * material.reflectance[c]),
                     max_reflectance - material.transmittance[c]);
    }
    for (const char* picture : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"})
        if (through->find(picture))
            plain_.note(material.name);
    if (material.is_translucent() && !material.two_sided) {
        material.two_sided = true;
        turned_.note(material.name);
    }
}

void GltfMaterials::read_emission(const JsonView& json, Material& material, GltfMaterial& result) {
    double strength = 1;
    if (auto strong = extension(json, "KHR_materials_emissive_strength"))
        if (auto value = strong->find("emissiveStrength"))
            strength = value->number(0, 1e15);
    bool emits = false;
    if (auto factor = json.find("emissiveFactor")) {
        if (factor->size() != 3)
            factor->fail("must have three numbers");
        for (std::size_t c = 0; c < 3; ++c) {
            material.emission[c] =
                static_cast<float>(pi * factor->at(c).number(0, 1e15) * strength);
            emits = emits || material.emission[c] > 0;
        }
    }
    auto texture = json.find("emissiveTexture");
    if (!emits || !texture)  // without a factor the texture is multiplied by 0
        return;
    UvSource source;
    material.emission_texture = read_texture(*texture, source);
    if (material.emission_texture == none)
        return;
    bool shared = result.uv0 && *result.uv0 == source;
    material.emission_uv = shared ? 0 : 1;
    if (!shared)
        result.uv1 = source;
}

std::uint32_t GltfMaterials::read_texture(const JsonView& info, UvSource& source) {
    source.set = info.count_or("texCoord", 0, 255);
    if (auto transform = extension(info, "KHR_texture_transform")) {
        source.set = transform->count_or("texCoord", source.set, 255);
        source.offset = vec2_or(*transform, "offset", glm::vec2(0));
        source.scale = vec2_or(*transform, "scale", glm::vec2(1));
        source.rotation = static_cast<float>(transform->number_or("rotation", 0));
    }
    JsonView texture = document_.element("textures", info.at("index"));
    if (auto sampler = texture.find("sampler")) {
        JsonView json = document_.element("samplers", *sampler);
        for (const char* wrap : {"wrapS", "wrapT"})
            if (json.count_or(wrap, 10497, 65535) != 10497)
                clamped_.note(json.path());
    }
    auto reference = texture.find("source");
    if (!reference) {
        builder_.scene().warnings.push_back(printable(texture.path()) +
                                            ": a texture without a picture; its factor alone is "
                                            "used");
        return none;
    }
    JsonView image = document_.element("images", *reference);
    if (auto uri = image.find("uri")) {
        if (!is_data_uri(uri->text()))
            return textures_.read(uri->path(), uri->text());
        return textures_.read_bytes(image.path(), image.path(),
                                    decode_data_uri(image.file(), uri->path(), uri->text()));
    }
    std::string bytes(document_.view_bytes(image.at("bufferView")));
    return textures_.read_bytes(image.path(), image.path(), bytes);
}

void GltfMaterials::finish() {
    Scene& scene = builder_.scene();
    metals_.warn(scene, "materials", "are metallic by glTF's default alone and taken as diffuse");
    plain_metals_.warn(scene, "materials",
                       "are metallic or rough by a picture; their factors alone are used");
    both_.warn(scene, "materials", "are metallic and transmit; they are taken as metals");
    smooth_.warn(scene, "materials", "are rough glass and taken as smooth");
    transparent_.warn(scene, "materials", "are mostly transparent and taken as opaque");
    white_.warn(scene, "materials", "have reflectance 1 and are taken as 0.999");
    plain_.warn(scene, "materials", "let light through by a picture; its factor alone is used");
    turned_.warn(scene, "materials", "let light through and are taken as two-sided");
    clamped_.warn(scene, "samplers", "do not repeat; their textures repeat here");
}

}  // namespace parallux
