#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <span>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "output/bake_values.h"
#include "output/bake_writers.h"
#include "parallux/error.h"

// Khronos Group, glTF 2.0 specification, 2021, sections 3 (JSON) and 4 (GLB).

namespace parallux {

static_assert(std::endian::native == std::endian::little, "files here are little endian");

namespace {

using Json = nlohmann::ordered_json;

constexpr int float_type = 5126, unsigned_int_type = 5125;
constexpr int vertex_target = 34962, index_target = 34963;

std::string base64(const std::string& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t triple = 0;
        for (std::size_t k = 0; k < 3; ++k)
            triple =
                triple << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[triple >> (18 - 6 * k) & 63];
    }
    return text;
}

class GltfBake {
public:
    GltfBake(const Scene& scene, const Bake& bake, const std::string& lightmap)
        : scene_(scene), bake_(bake), lightmap_(lightmap) {
        json_["asset"] = {{"version", "2.0"},
                          {"generator", std::string("Parallux ") + PARALLUX_VERSION},
                          {"extras", extras()}};
        json_["scene"] = 0;
        json_["scenes"] = Json::array({{{"nodes", Json::array()}}});
        json_["nodes"] = json_["meshes"] = json_["materials"] = json_["accessors"] =
            json_["bufferViews"] = Json::array();
        add_attributes();
        for (std::size_t i = 0; i < bake.parts.size(); ++i)
            add_part(bake.parts[i], i == 0 || bake.parts[i].object != bake.parts[i - 1].object);
        if (!extensions_.empty())
            json_["extensionsUsed"] = extensions_;
    }

    /// The JSON, with the buffer behind it or inside.
    std::string text(const std::string& buffer_uri) {
        Json buffer = {{"byteLength", bytes_.size()}};
        if (!buffer_uri.empty())
            buffer["uri"] = buffer_uri;
        json_["buffers"] = Json::array({buffer});
        // Names may hold any bytes; JSON may not.
        return json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    const std::string& bytes() const { return bytes_; }

private:
    Json extras() const {
        const BakeSettings& settings = bake_.settings;
        Json result = {{"scene", scene_.file.filename().string()},
                       {"quantity", quantity_name(settings.quantity)},
                       {"unit", quantity_unit(settings.quantity)},
                       {"colour_space", "linear Rec.709"}};
        if (scene_.bands != 3)
            result["bands"] = "mean of " + std::to_string(scene_.bands);
        result["sides"] = "a two-sided surface is two faces where its sides differ";
        if (!lightmap_.empty()) {
            result["lightmap"] = {{"uri", lightmap_}, {"texCoord", 1}};
            return result;
        }
        result["exposure"] = bake_.factor;
        result["clamped"] = settings.unlit;
        result["COLOR_0"] =
            settings.unlit ? "exposure * quantity, clamped to [0, 1]" : "quantity, may be above 1";
        return result;
    }

    template <class T>
    std::size_t add_view(const std::vector<T>& values, int target) {
        std::span<const std::byte> raw = std::as_bytes(std::span(values));
        Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", raw.size()}};
        if (target == vertex_target)
            view["byteStride"] = sizeof(T);
        view["target"] = target;
        json_["bufferViews"].push_back(view);
        bytes_.append(reinterpret_cast<const char*>(raw.data()), raw.size());
        return json_["bufferViews"].size() - 1;
    }

    void add_attributes() {
        auto add = [&](const char* name, const auto& values, const char* type) {
            if (!values.empty())
                attributes_.push_back(
                    {name, type, sizeof values[0], add_view(values, vertex_target)});
        };
        add("POSITION", bake_.positions, "VEC3");
        add("NORMAL", bake_.normals, "VEC3");
        add("COLOR_0", bake_.colours, "VEC3");
        add("TEXCOORD_0", bake_.uv0, "VEC2");
        add("TEXCOORD_1", bake_.uv1, "VEC2");
    }

    std::size_t add_accessor(Json accessor) {
        json_["accessors"].push_back(std::move(accessor));
        return json_["accessors"].size() - 1;
    }

    void add_part(const BakePart& part, bool first_of_object) {
        if (first_of_object) {
            Json name = part.object == none ? Json("bake") : Json(scene_.objects[part.object]);
            json_["scenes"][0]["nodes"].push_back(json_["nodes"].size());
            json_["nodes"].push_back({{"name", name}, {"mesh", json_["meshes"].size()}});
            json_["meshes"].push_back(
                {{"name", name}, {"primitives", Json::array()}, {"extras", extras()}});
        }
        Json attributes;
        for (const Attribute& a : attributes_) {
            Json accessor = {{"bufferView", a.view},
                             {"byteOffset", a.bytes * part.first_vertex},
                             {"componentType", float_type},
                             {"count", part.vertices},
                             {"type", a.type}};
            if (a.name == std::string("POSITION"))
                add_bounds(part, accessor);
            attributes[a.name] = add_accessor(std::move(accessor));
        }
        std::size_t indices = add_accessor({{"bufferView", add_view(part.indices, index_target)},
                                            {"componentType", unsigned_int_type},
                                            {"count", part.indices.size()},
                                            {"type", "SCALAR"}});
        json_["meshes"].back()["primitives"].push_back({{"attributes", attributes},
                                                        {"indices", indices},
                                                        {"material", material(part)},
                                                        {"extras", extras()}});
    }

    void add_bounds(const BakePart& part, Json& accessor) const {
        glm::vec3 low = bake_.positions[part.first_vertex], high = low;
        for (std::uint32_t v = 1; v < part.vertices; ++v) {
            low = glm::min(low, bake_.positions[part.first_vertex + v]);
            high = glm::max(high, bake_.positions[part.first_vertex + v]);
        }
        accessor["min"] = {low.x, low.y, low.z};
        accessor["max"] = {high.x, high.y, high.z};
    }

    std::size_t material(const BakePart& part) {
        auto [known, is_new] =
            materials_.try_emplace({part.material, part.both_sides}, json_["materials"].size());
        if (is_new)
            json_["materials"].push_back(material_of(part));
        return known->second;
    }

    // White under vertex colours, which then are what is seen; else the scene's own.
    Json material_of(const BakePart& part) {
        const Material& m = scene_.materials[part.material];
        glm::vec3 base(1);
        if (!lightmap_.empty())
            base = glm::clamp(colour_of(m.reflectance.value.data(), scene_.bands), 0.0f, 1.0f);
        Json result = {{"name", m.name},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {base.x, base.y, base.z, 1}},
                         {"metallicFactor", 0},
                         {"roughnessFactor", 1}}},
                       {"doubleSided", part.both_sides}};
        if (!lightmap_.empty())
            add_emission(m, result);
        if (bake_.settings.unlit && lightmap_.empty()) {
            use("KHR_materials_unlit");
            result["extensions"]["KHR_materials_unlit"] = Json::object();
        }
        return result;
    }

    // glTF's emission is radiance, E / π: a factor of at most 1, and a strength.
    void add_emission(const Material& m, Json& result) {
        const glm::vec3 e = colour_of(m.emission.value.data(), scene_.bands) / float(pi);
        const float most = std::max({e.x, e.y, e.z});
        if (!(most > 0))
            return;
        const float strength = std::max(most, 1.0f);
        const glm::vec3 factor = glm::min(e / strength, 1.0f);
        result["emissiveFactor"] = {factor.x, factor.y, factor.z};
        if (strength > 1) {
            use("KHR_materials_emissive_strength");
            result["extensions"]["KHR_materials_emissive_strength"] = {
                {"emissiveStrength", strength}};
        }
    }

    void use(const char* extension) {
        if (std::find(extensions_.begin(), extensions_.end(), extension) == extensions_.end())
            extensions_.push_back(extension);
    }

    struct Attribute {
        const char* name;
        const char* type;
        std::size_t bytes;
        std::size_t view;
    };

    const Scene& scene_;
    const Bake& bake_;
    const std::string& lightmap_;
    Json json_;
    std::string bytes_;
    std::vector<Attribute> attributes_;
    std::map<std::pair<std::uint32_t, bool>, std::size_t> materials_;
    std::vector<std::string> extensions_;
};

std::string word(std::size_t value) {
    std::string bytes(4, '\0');
    const auto narrow = static_cast<std::uint32_t>(value);
    std::memcpy(bytes.data(), &narrow, 4);
    return bytes;
}

}  // namespace

void write_gltf(OutputFile& output, const std::filesystem::path& file, const Scene& scene,
                const Bake& bake, bool glb, const std::string& lightmap) {
    GltfBake gltf(scene, bake, lightmap);
    if (!glb)
        return output.write(
            gltf.text("data:application/octet-stream;base64," + base64(gltf.bytes())) + "\n");
    std::string json = gltf.text({});
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t binary = gltf.bytes().size();  // floats and 32-bit indices: whole words
    const std::size_t total = 12 + 8 + json.size() + 8 + binary;
    if (total > 0xffffffffu)
        throw Error(Fault::output, file.string() +
                                       ": a GLB holds 4 GiB and this bake needs more; "
                                       "use larger patches or --bake-mesh original");
    output.write("glTF" + word(2) + word(total) + word(json.size()) + "JSON");
    output.write(json);
    output.write(word(binary) + std::string("BIN\0", 4));
    output.write(gltf.bytes());
}

}  // namespace parallux
