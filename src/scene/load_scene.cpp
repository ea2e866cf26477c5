#include <algorithm>
#include <cctype>
#include <cmath>

#include "parallux/error.h"
#include "scene/input.h"
#include "scene/loaders.h"
#include "scene/obj.h"
#include "scene/sky_models.h"

namespace parallux {
namespace {

enum class Format { gltf, obj, stl, json, unknown };

std::string ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

// The ending where it is known, else the content.
Format format_of(const std::filesystem::path& file, const std::string& bytes) {
    if (bytes.compare(0, 4, "glTF") == 0)
        return Format::gltf;
    std::string ending = ending_of(file);
    if (ending == ".gltf" || ending == ".glb")
        return Format::gltf;
    if (ending == ".obj")
        return Format::obj;
    if (ending == ".stl")
        return Format::stl;
    if (ending == ".json")
        return Format::json;
    std::size_t begin = bytes.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0;
    begin = bytes.find_first_not_of(" \t\r\n", begin);
    if (begin != bytes.npos && bytes[begin] == '{')
        return Format::json;
    if (looks_like_stl(bytes))
        return Format::stl;
    return looks_like_obj(bytes) ? Format::obj : Format::unknown;
}

void read_json(SceneBuilder& builder, std::string bytes) {
    Json json = parse_json(builder.scene().file, bytes);
    JsonView root(builder.scene().file, json);
    if (root.has("parallux"))
        return read_parallux(builder, json);
    if (root.has("asset"))
        return read_gltf(builder, std::move(bytes));
    root.fail("neither a Parallux scene (key \"parallux\") nor glTF (key \"asset\")");
}

void read_any(SceneBuilder& builder, std::string bytes) {
    switch (format_of(builder.scene().file, bytes)) {
        case Format::gltf:
            return read_gltf(builder, std::move(bytes));
        case Format::obj:
            return read_obj(builder, bytes);
        case Format::stl:
            return read_stl(builder, bytes);
        case Format::json:
            return read_json(builder, std::move(bytes));
        case Format::unknown:
            break;
    }
    input_error(builder.scene().file, "",
                "unknown format; scenes are read from glTF (.gltf, .glb), OBJ, STL and Parallux "
                "JSON");
}

}  // namespace

Scene scene_of(const std::filesystem::path& file, std::string bytes, const LoadSettings& settings) {
    if (!(settings.scale > 0 && settings.scale <= 1e15))
        throw Error(Fault::usage, "the scale of a scene must be more than 0");
    Scene scene;
    scene.file = file;
    SceneBuilder builder(scene, settings);
    try {
        read_any(builder, std::move(bytes));
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, printable(file.string(), 400) + ": too large for this machine");
    }
    if (scene.surfaces.empty())
        input_error(file, "",
                    "nothing with area in it (" + std::to_string(scene.triangles) +
                        " triangles); a scene needs surfaces");
    if (settings.period[0] > 0 || settings.period[1] > 0) {
        // Along x, and along y or, where y is up, z.
        const int second = std::abs(scene.sky.up.y) > 0.5 ? 2 : 1;
        scene.period = {glm::dvec3(0), glm::dvec3(0)};
        scene.period[0].x = settings.period[0] * settings.scale;
        scene.period[1][second] = settings.period[1] * settings.scale;
        refuse_curves(scene, "those do not repeat; take the period away");
        if (auto wrong = settle_period(scene))
            throw Error(Fault::usage, printable(file.string(), 400) + ": " + *wrong);
    }
    if (auto wrong = put_sky(scene, settings.sky))
        throw Error(Fault::usage, printable(file.string(), 400) + ": " + *wrong);
    if (scene.zero_area > 0)
        scene.warnings.push_back(std::to_string(scene.zero_area) + " of " +
                                 std::to_string(scene.triangles) +
                                 " triangles have no area and are left out");
    return scene;
}

Scene load_scene(const std::filesystem::path& file, const LoadSettings& settings) {
    return scene_of(file, read_file(file), settings);
}

std::string name_or(const std::string& name, const std::string& otherwise) {
    return name.empty() ? otherwise : printable(name);
}

std::uint32_t add_object(Scene& scene, const std::string& name) {
    scene.objects.push_back(printable(name));
    return static_cast<std::uint32_t>(scene.objects.size() - 1);
}

std::uint32_t add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

Material default_material(const LoadSettings& settings, bool two_sided) {
    Material material;
    material.name = "default";
    material.reflectance = settings.reflectance;
    material.two_sided = two_sided;
    return material;
}

void Tally::warn(Scene& scene, const std::string& noun, const std::string& what) const {
    if (count > 0)
        scene.warnings.push_back(std::to_string(count) + " " + noun + " (first: " + first + ") " +
                                 what);
}

}  // namespace parallux
