#include "../scene/scene_files.h"

#include "parallux/changes.h"
#include "parallux/patches.h"
#include "parallux/tables.h"
#include "parallux/thermal.h"

using namespace parallux;

namespace {

const std::string two_quads =
    R"({"parallelogram": [[0,0,0],[1,0,0],[0,1,0]], "material": "m", "grid": [1, 1]})";

std::string scene(const std::string& material, const std::string& more = "") {
    return R"({"parallux": 1)" + more + R"(, "materials": [{"name": "m", )" + material +
           R"(}], "surfaces": [)" + two_quads + "]}";
}

std::string gltf(const std::string& extension, bool double_sided) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0,0,0], "max": [1,1,0]}],
        "materials": [{"name": "leaf", "doubleSided": )" +
           std::string(double_sided ? "true" : "false") + R"(, "extensions": {)" + extension +
           R"(}, "pbrMetallicRoughness": {"metallicFactor": 0,
                       "baseColorFactor": [0.5, 0.25, 0, 1]}}]})";
}

const std::string diffuse_transmission =
    R"("KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.4,
       "diffuseTransmissionColorFactor": [1, 0.5, 0]})";

}  // namespace

// Planted, seen to fail: the back's values put to the front.
TEST_CASE("a Parallux scene says what each side lets through") {
    TestFolder folder;
    const Scene same = load_scene(folder.write(
        "a.json",
        scene(R"("reflectance": 0.3, "transmittance": [0.1, 0.2, 0.3], "two_sided": true)")));
    Patches patches = make_patches(same);
    REQUIRE(patches.count() == 2);
    REQUIRE(patches.translucent());
    CHECK(patches.other[0] == 1);
    CHECK(patches.other[1] == 0);
    for (std::size_t side : {0, 1})
        for (std::size_t band : {0, 1, 2}) {
            CHECK(patches.transmittance[3 * side + band] ==
                  doctest::Approx(0.1 * double(band + 1)));
            CHECK(patches.reflectance[3 * side + band] == doctest::Approx(0.3));
        }
    const Scene unlike = load_scene(
        folder.write("b.json", scene(R"("reflectance": 0.3, "transmittance": 0.2, "two_sided": true,
                           "back": {"transmittance": 0.5})")));
    patches = make_patches(unlike);
    CHECK(patches.transmittance[0] == 0.2f);
    CHECK(patches.transmittance[3] == 0.5f);
    CHECK(patches.reflectance[3] == 0.3f);
    const Scene opaque =
        load_scene(folder.write("c.json", scene(R"("reflectance": 0.3, "two_sided": true)")));
    CHECK(!make_patches(opaque).translucent());
}

// Planted, seen to fail: the check of one-sided materials left out.
TEST_CASE("transmittances that cannot be are refused, in one line") {
    TestFolder folder;
    auto fault = [&](const std::string& material) {
        return fault_of(folder.write("x.json", scene(material)));
    };
    CHECK(holds(fault(R"("reflectance": 0.6, "transmittance": 0.5, "two_sided": true)"),
                "/materials/0: reflectance and transmittance must be less than 1 together"));
    CHECK(holds(fault(R"("reflectance": 0.5, "transmittance": 0.5, "two_sided": true)"),
                "less than 1 together"));
    CHECK(holds(fault(R"("reflectance": 0.5, "transmittance": -0.1, "two_sided": true)"),
                "/materials/0/transmittance: -0.1 is outside"));
    CHECK(holds(fault(R"("reflectance": 0.5, "transmittance": 0.1)"),
                "/materials/0: only what is two-sided"));
    CHECK(holds(fault(R"("reflectance": 0.5, "back": {"reflectance": 0.1})"),
                "/materials/0: only what is two-sided"));
    CHECK(holds(fault(R"("reflectance": 0.5, "two_sided": true,
                        "back": {"reflectance": 0.6, "transmittance": 0.4})"),
                "/materials/0: back: reflectance"));
    CHECK(holds(fault(R"("reflectance": 0.5, "two_sided": true, "back": {"emission": 1})"),
                "/materials/0/back/emission: unknown key"));
    CHECK(holds(fault(R"("reflectance": 0.5, "transmittance": [0.1], "two_sided": true)"),
                "/materials/0/transmittance: must be a number or"));
}

// Planted, seen to fail: ρ left whole beside τ.
TEST_CASE("glTF's diffuse transmission takes its share from the base colour") {
    TestFolder folder;
    const Scene scene = load_scene(folder.write("a.gltf", gltf(diffuse_transmission, true)));
    const Material& leaf = scene.materials[scene.surfaces[0].material];
    CHECK(leaf.transmittance[0] == doctest::Approx(0.4));
    CHECK(leaf.transmittance[1] == doctest::Approx(0.2));
    CHECK(leaf.transmittance[2] == 0);
    CHECK(leaf.reflectance[0] == doctest::Approx(0.3));
    CHECK(leaf.reflectance[1] == doctest::Approx(0.15));
    CHECK(scene.warnings.empty());
    const Scene turned = load_scene(folder.write("b.gltf", gltf(diffuse_transmission, false)));
    CHECK(turned.materials[turned.surfaces[0].material].two_sided);
    REQUIRE(turned.warnings.size() == 1);
    CHECK(holds(turned.warnings[0], "two-sided"));
    CHECK(holds(fault_of(folder.write("c.gltf", gltf(R"("KHR_materials_diffuse_transmission":
                                      {"diffuseTransmissionFactor": 2})",
                                                     true))),
                "diffuseTransmissionFactor"));
}

// Planted, seen to fail: a front of the table beside a back of the scene.
TEST_CASE("tables of materials say it by columns") {
    TestFolder folder;
    const auto file =
        folder.write("a.json", scene(R"("reflectance": 0.3, "transmittance": 0.2, "two_sided": true,
                           "back": {"transmittance": 0.5})"));
    auto with = [&](const std::string& table) {
        Scene scene = load_scene(file);
        set_materials(scene, folder.write("m.csv", table), 0);
        return scene.materials[0];
    };
    Material m = with("material,reflectance_0,transmittance_0\nm,0.1,0.6\n");
    CHECK(m.transmittance[0] == 0.6f);
    CHECK(!m.own_back);
    m = with("material,transmittance_0,back_reflectance_0,back_transmittance_0\nm,0.6,0,0.7\n");
    CHECK(m.reflectance[0] == 0.3f);
    CHECK(m.transmittance[0] == 0.6f);
    CHECK(m.back_reflectance[0] == 0);
    CHECK(m.back_transmittance[0] == 0.7f);
    m = with("material,back_reflectance_0\nm,0.4\n");
    CHECK(m.back_reflectance[0] == 0.4f);
    CHECK(m.back_transmittance[0] == 0.5f);
    m = with("material,emission_0\nm,4\n");
    CHECK(m.back_transmittance[0] == 0.5f);
    for (const char* table :
         {"material,reflectance_0,transmittance_0\nm,0.5,0.5\n",
          "material,transmittance_0\nm,-0.1\n", "material,back_transmittance_0\nm,0.7\n",
          "material,transmittance_0,reflectance_0,reflectance_1\nm,0.1,0.1,0.1\n"}) {
        CAPTURE(std::string(table));
        CHECK_THROWS_AS(with(table), Error);
    }
    folder.write("one.json", scene(R"("reflectance": 0.3)"));
    Scene one_sided = load_scene(folder.path() / "one.json");
    CHECK_THROWS_AS(
        set_materials(one_sided, folder.write("m.csv", "material,transmittance_0\nm,0.1\n"), 0),
        Error);
}

// Planted, seen to fail: columns in every table.
TEST_CASE("tables of patches have transmittances behind all else, and only where there are any") {
    TestFolder folder;
    auto table_of = [&](const std::string& material) {
        const Scene loaded = load_scene(folder.write("a.json", scene(material)));
        const Patches patches = make_patches(loaded);
        Solution solution;
        solution.bands = 3;
        solution.radiosity.assign(patches.count() * 3, 1);
        solution.irradiance = solution.radiosity;
        write_table(folder.path() / "t.csv", loaded, patches, solution);
        CHECK(compare_tables(folder.path() / "t.csv", folder.path() / "t.csv").relative_rms == 0);
        const std::string bytes = bytes_of(folder.path() / "t.csv");
        return bytes.substr(0, bytes.find('\n')) + bytes.substr(bytes.rfind(',', bytes.size() - 2));
    };
    CHECK(holds(table_of(R"("reflectance": 0.3, "transmittance": 0.25, "two_sided": true)"),
                "stderr_b,transmittance_r,transmittance_g,transmittance_b,0.25"));
    CHECK(!holds(table_of(R"("reflectance": 0.3, "two_sided": true)"), "transmittance"));
}
