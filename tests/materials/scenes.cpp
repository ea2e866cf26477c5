#include "../scene/scene_files.h"

#include "materials/shiny.h"
#include "parallux/patches.h"
#include "parallux/predict.h"
#include "parallux/result.h"
#include "parallux/sensors.h"
#include "parallux/thermal.h"

using namespace parallux;

namespace {

std::string scene(const std::string& material) {
    return R"({"parallux": 1, "materials": [{"name": "m", )" + material +
           R"(}], "surfaces": [{"parallelogram": [[0,0,0],[1,0,0],[0,1,0]], "material": "m",
                                "grid": [1, 1]}]})";
}

std::string gltf(const std::string& pbr, const std::string& extensions = "") {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0,0,0], "max": [1,1,0]}],
        "materials": [{"name": "m", "extensions": {)" +
           extensions + "}" + (pbr.empty() ? "" : R"(, "pbrMetallicRoughness": {)" + pbr + "}") +
           "}]}";
}

}  // namespace

TEST_CASE("a Parallux scene says what mirrors and what is glass") {
    TestFolder folder;
    auto read = [&](const std::string& material) {
        return load_scene(folder.write("a.json", scene(material)));
    };
    Scene s = read(R"("mirror": {"reflectance": [0.9, 0.8, 0.7], "roughness": 0.3})");
    const Specular& mirror = s.materials[0].specular;
    CHECK(mirror.kind == Specular::Kind::mirror);
    CHECK(mirror.share == 1);
    CHECK(mirror.roughness == 0.3f);
    CHECK(mirror.grazing == mirror.colour);
    CHECK(surface_tint(s, 0, 0.5, 0.5)[1] == 0.8f);
    Patches patches = make_patches(s);
    CHECK(patches.specular == std::vector<float>{1});
    CHECK(patches.reflectance == std::vector<float>{0, 0, 0});

    s = read(R"("reflectance": 0.4, "mirror": {"reflectance": 0.9, "share": 0.25, "grazing": 1})");
    patches = make_patches(s);
    CHECK(patches.specular == std::vector<float>{0.25f});
    CHECK(patches.reflectance[0] == 0.4f);
    CHECK(s.materials[0].specular.grazing[2] == 1);

    // Glass has two sides, whatever is said.
    s = read(R"("glass": {"ior": 1.7, "absorption": [1, 2, 3], "colour": 0.9})");
    const Specular& glass = s.materials[0].specular;
    CHECK(glass.kind == Specular::Kind::glass);
    CHECK(glass.ior == 1.7);
    CHECK(glass.absorption[2] == 3);
    CHECK(!glass.thin);
    CHECK(make_patches(s).specular == std::vector<float>{1, 1});
    CHECK(read(R"("glass": {"thin": true})").materials[0].specular.ior == 1.5);

    s = read(R"("reflectance": 0.5)");
    CHECK(!is_specular(s));
    CHECK(make_patches(s).specular.empty());
}

TEST_CASE("mirrors and glass that cannot be are refused, in one line") {
    TestFolder folder;
    auto fault = [&](const std::string& material) {
        return fault_of(folder.write("x.json", scene(material)));
    };
    CHECK(holds(fault(R"("mirror": {})"), "/materials/0/mirror"));
    CHECK(holds(fault(R"("mirror": {"reflectance": 1})"),
                "/materials/0/mirror/reflectance: must be less than 1"));
    CHECK(holds(fault(R"("mirror": {"reflectance": 0.5, "roughness": 2})"),
                "/materials/0/mirror/roughness"));
    CHECK(holds(fault(R"("mirror": {"reflectance": 0.5, "ior": 2})"), "unknown key"));
    CHECK(holds(fault(R"("glass": {"ior": 0.5})"), "/materials/0/glass/ior"));
    CHECK(holds(fault(R"("glass": {"absorption": -1})"), "/materials/0/glass/absorption"));
    CHECK(holds(fault(R"("glass": {}, "mirror": {"reflectance": 0.5})"), "a mirror or glass"));
    CHECK(holds(fault(R"("reflectance": 0.5, "glass": {})"),
                "/materials/0/reflectance: the mirror or glass leaves nothing"));
}

TEST_CASE("glTF's metals mirror, and what it transmits is glass") {
    TestFolder folder;
    auto read = [&](const std::string& pbr, const std::string& extensions = "") {
        return load_scene(folder.write("a.gltf", gltf(pbr, extensions)));
    };
    const std::string colour = R"("baseColorFactor": [0.5, 0.25, 0, 1])";
    // Metal where pbrMetallicRoughness does not say otherwise, as Blender writes it.
    Scene s = read(colour + R"(, "roughnessFactor": 0.5)");
    CHECK(s.materials[0].specular.kind == Specular::Kind::mirror);
    CHECK(s.materials[0].specular.share == 1);
    CHECK(s.materials[0].specular.roughness == 0.5f);
    CHECK(s.materials[0].specular.colour[1] == 0.25f);
    CHECK(s.materials[0].specular.grazing[1] == 1);
    CHECK(s.materials[0].reflectance[0] == 0);
    CHECK(s.warnings.empty());
    s = read(colour + R"(, "metallicFactor": 0.25)");
    CHECK(s.materials[0].specular.share == 0.25f);
    CHECK(s.materials[0].reflectance[0] == 0.5f);
    CHECK(!is_specular(read(colour + R"(, "metallicFactor": 0)")));
    // A material that says nothing of it is diffuse, and a warning tells.
    s = read("");
    CHECK(!is_specular(s));
    CHECK(s.warnings.size() == 2);  // and white

    const std::string dielectric = colour + R"(, "metallicFactor": 0, "roughnessFactor": 0)";
    s = read(dielectric, R"("KHR_materials_transmission": {"transmissionFactor": 0.75},
                            "KHR_materials_ior": {"ior": 1.4})");
    const Specular& sheet = s.materials[0].specular;
    CHECK(sheet.kind == Specular::Kind::glass);
    CHECK(sheet.thin);
    CHECK(sheet.ior == 1.4);
    CHECK(sheet.share == 0.75f);
    CHECK(s.materials[0].two_sided);
    CHECK(s.materials[0].reflectance[0] == 0.5f);
    LoadSettings settings;
    settings.scale = 2;
    s = load_scene(
        folder.write("b.gltf", gltf(dielectric,
                                    R"("KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.5,
                                     "attenuationColor": [1, 0.5, 0.25]})")),
        settings);
    const Specular& body = s.materials[0].specular;
    CHECK(!body.thin);
    CHECK(body.ior == 1.5);
    CHECK(body.absorption[0] == 0);
    CHECK(body.absorption[1] == doctest::Approx(std::log(2)));  // a half by a metre: 0.5 · 2
    CHECK(body.absorption[2] == doctest::Approx(std::log(4)));
    // A factor of 0 is none.
    CHECK(!is_specular(read(dielectric, R"("KHR_materials_transmission": {})")));
}

TEST_CASE("a scene's hash knows all that its mirrors and glass are") {
    TestFolder folder;
    std::vector<std::uint64_t> hashes;
    for (const char* material :
         {R"("mirror": {"reflectance": 0.5})", R"("mirror": {"reflectance": 0.6})",
          R"("mirror": {"reflectance": 0.5, "grazing": 1})",
          R"("mirror": {"reflectance": 0.5, "roughness": 0.1})",
          R"("reflectance": 0, "mirror": {"reflectance": 0.5, "share": 0.5})", R"("glass": {})",
          R"("glass": {"ior": 1.6})", R"("glass": {"thin": true})", R"("glass": {"absorption": 1})",
          R"("glass": {"colour": 0.5})", R"("reflectance": 0, "two_sided": true)",
          R"("reflectance": 0)"}) {
        const Scene s = load_scene(folder.write("a.json", scene(material)));
        hashes.push_back(scene_hash(s, make_patches(s)));
    }
    std::sort(hashes.begin(), hashes.end());
    CHECK(std::unique(hashes.begin(), hashes.end()) == hashes.end());
}

TEST_CASE("predictions and sensors refuse mirrors") {
    TestFolder folder;
    Scene s = test::room(test::grey(0.5, 1), 1);
    s.materials[0] = test::mirror(0.5);
    const Patches patches = make_patches(s);
    CHECK_THROWS_AS(predict_error(s, patches, {}), Error);
    SolveSettings settings;
    settings.bundles = 8;
    const Solution solution = solve(s, patches, settings);
    CHECK_THROWS_AS(sense(s, patches, solution, {Sensor{}}, {}), Error);
}
