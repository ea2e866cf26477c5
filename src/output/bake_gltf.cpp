#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "output/bake_values.h"
#include "output/bake_writers.h"
#include "output/gltf_looks.h"

namespace parallux {

namespace {

using Json = GltfFile::Json;

constexpr int float_type = 5126, unsigned_int_type = 5125;

// COLOR_0 must lie within [0, 1] (section 3.7.2.1). A power of two brings it there and loses
// nothing.
float fitting_scale(const std::vector<glm::vec3>& colours) {
    float most = 0;
    for (const glm::vec3& c : colours)
        most = std::max({most, c.x, c.y, c.z});
    return most > 1 ? std::exp2(-std::ceil(std::log2(most))) : 1;
}

class GltfBake {
public:
    GltfBake(const Scene& scene, const Bake& bake, const LightmapNames& lightmap)
        : scene_(scene),
          bake_(bake),
          lightmap_(lightmap),
          scale_(fitting_scale(bake.colours)),
          gltf_(extras(none)),
          looks_(scene, bake.settings, bool(lightmap), gltf_) {
        add_attributes();
        for (std::size_t i = 0; i < bake.parts.size(); ++i)
            add_part(bake.parts[i], i == 0 || bake.parts[i].object != bake.parts[i - 1].object);
    }

    GltfFile& file() { return gltf_; }

private:
    // Of the whole file (none), or of one object.
    Json extras(std::uint32_t object) const {
        const BakeSettings& settings = bake_.settings;
        Json result = {{"scene", scene_.file.filename().string()},
                       {"quantity", quantity_name(settings.quantity)},
                       {"unit", quantity_unit(settings.quantity)},
                       {"colour_space", "linear Rec.709"}};
        if (scene_.bands != 3)
            result["bands"] = "mean of " + std::to_string(scene_.bands);
        result["sides"] = "a two-sided surface is two faces where its sides differ";
        if (lightmap_) {
            if (const std::string name = lightmap_(object); !name.empty())
                result["lightmap"] = {{"uri", name}, {"texCoord", 1}};
            return result;
        }
        result["exposure"] = bake_.factor * scale_;
        result["clamped"] = settings.unlit;
        result["COLOR_0"] = settings.unlit ? "exposure * quantity, clamped to [0, 1]"
                                           : "exposure * quantity: divide by exposure";
        return result;
    }

    Json extras(const BakePart& part) const {
        Json result = extras(part.object);
        if (!lightmap_ && keeps_picture(scene_, bake_.settings, part.material))
            result["COLOR_0"] =
                std::string(result["COLOR_0"]) + "; baseColorTexture is taken out and multiplies";
        return result;
    }

    void add_attributes() {
        auto add = [&](const char* name, const auto& values, const char* type) {
            if (!values.empty())
                attributes_.push_back(
                    {name, type, sizeof values[0], gltf_.add_values(values, true)});
        };
        std::vector<glm::vec3> colours = bake_.colours;
        for (glm::vec3& colour : colours)
            colour *= scale_;
        add("POSITION", bake_.positions, "VEC3");
        add("NORMAL", bake_.normals, "VEC3");
        add("COLOR_0", colours, "VEC3");
        // Sets must be numbered from 0: where the scene has none, the lightmap's is the first too.
        add("TEXCOORD_0", bake_.uv0.empty() ? bake_.uv1 : bake_.uv0, "VEC2");
        add("TEXCOORD_1", bake_.uv1, "VEC2");
        add("TEXCOORD_2", bake_.uv2, "VEC2");
    }

    void add_part(const BakePart& part, bool first_of_object) {
        if (first_of_object) {
            Json name = part.object == none ? Json("bake") : Json(scene_.objects[part.object]);
            const std::size_t mesh = gltf_.add(
                "meshes",
                {{"name", name}, {"primitives", Json::array()}, {"extras", extras(part.object)}});
            const std::size_t node = gltf_.add("nodes", {{"name", name}, {"mesh", mesh}});
            gltf_["scenes"][0]["nodes"].push_back(node);
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
            attributes[a.name] = gltf_.add("accessors", std::move(accessor));
        }
        const std::size_t indices =
            gltf_.add("accessors", {{"bufferView", gltf_.add_values(part.indices, false)},
                                    {"componentType", unsigned_int_type},
                                    {"count", part.indices.size()},
                                    {"type", "SCALAR"}});
        // Made first: new arrays move what the document's references point to.
        Json primitive = {{"attributes", attributes},
                          {"indices", indices},
                          {"material", looks_.of(part)},
                          {"extras", extras(part)}};
        gltf_["meshes"].back()["primitives"].push_back(std::move(primitive));
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

    struct Attribute {
        const char* name;
        const char* type;
        std::size_t bytes;
        std::size_t view;
    };

    const Scene& scene_;
    const Bake& bake_;
    const LightmapNames& lightmap_;
    float scale_;
    GltfFile gltf_;
    GltfLooks looks_;
    std::vector<Attribute> attributes_;
};

}  // namespace

void write_gltf(OutputFile& output, const std::filesystem::path& file, const Scene& scene,
                const Bake& bake, bool glb, const LightmapNames& lightmap) {
    GltfBake(scene, bake, lightmap).file().write(output, file, glb);
}

}  // namespace parallux
