#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "scene_files.h"

using namespace parallux;

namespace {

void put(std::string& bytes, std::uint32_t value) {
    for (int i = 0; i < 4; ++i)
        bytes += static_cast<char>(value >> (8 * i) & 255);
}

void put(std::string& bytes, float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, 4);
    put(bytes, bits);
}

// A unit square in z = 0 with corners at 0, 1: four positions, four texture coordinates, then the
// indices of two triangles as 32 bit numbers.
std::string square_bytes() {
    std::string bytes;
    const float corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (auto& c : corner) {
        put(bytes, c[0]);
        put(bytes, c[1]);
        put(bytes, 0.0f);
    }
    for (auto& c : corner) {
        put(bytes, c[0]);
        put(bytes, c[1]);
    }
    for (std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
        put(bytes, i);
    return bytes;
}

// A glTF scene of that square; texts replace its node, its material and what follows.
struct SquareGltf {
    std::string node = R"({"mesh": 0})";
    std::string material = R"({"pbrMetallicRoughness": {"metallicFactor": 0}})";
    std::string more;
    std::string count = "4";
    std::string buffer = R"("uri": "square.bin", )";

    std::string json() const {
        return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [)" + node +
               R"(], "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0,
               "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}], "materials": [)" +
               material +
               R"(], "accessors": [
               {"bufferView": 0, "componentType": 5126, "count": )" +
               count +
               R"(, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
               {"bufferView": 2, "componentType": 5125, "count": 6, "type": "SCALAR"}],
               "bufferViews": [{"buffer": 0, "byteLength": 48},
               {"buffer": 0, "byteOffset": 48, "byteLength": 32},
               {"buffer": 0, "byteOffset": 80, "byteLength": 24}],
               "buffers": [{)" +
               buffer + R"("byteLength": 104}])" + more + "}";
    }
    std::filesystem::path write(const TestFolder& folder) const {
        folder.write("square.bin", square_bytes());
        return folder.write("square.gltf", json());
    }
};

std::string glb_of(std::string json, const std::string& binary) {
    while (json.size() % 4 != 0)
        json += ' ';
    std::string bytes = "glTF";
    put(bytes, 2u);
    put(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
    put(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    put(bytes, static_cast<std::uint32_t>(binary.size()));
    return bytes + std::string("BIN\0", 4) + binary;
}

// Two texels: pure red half transparent, and sRGB 188, which is 0.5029 of the light.
const std::string two_texels =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP4z8DQsGfPnv"
    "8AEhwEsxXrFeUAAAAASUVORK5CYII=";

}  // namespace

// Fails when E lacks π or the strength, or when 1 is let through as a reflectance.
TEST_CASE("glTF materials") {
    TestFolder folder;
    SquareGltf file;
    file.material = R"({"name": "lamp", "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}}})";
    Scene s = load_scene(file.write(folder));
    REQUIRE(s.surfaces.size() == 1);
    CHECK(parallelograms(s) == 1);
    CHECK(s.attributes.empty());
    CHECK(s.materials[0].two_sided);
    CHECK(surface_emission(s, 0, 0, 0)[0] == doctest::Approx(10 * pi));
    CHECK(surface_emission(s, 0, 0, 0)[1] == doctest::Approx(5 * pi));
    CHECK(surface_reflectance(s, 0, 0, 0)[0] == 0.999f);
    CHECK(s.warnings.size() == 2);  // metallic by default, and white
}

// Fails when alpha darkens, sRGB is not decoded, or u runs backwards.
TEST_CASE("glTF textures are linear and lie as their coordinates say") {
    TestFolder folder;
    SquareGltf file;
    file.material = R"({"pbrMetallicRoughness": {"metallicFactor": 0,
        "baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}}})";
    file.more = R"(, "textures": [{"source": 0}], "images": [{"uri": ")" + two_texels + R"("}])";
    Scene s = load_scene(file.write(folder));
    REQUIRE(s.attributes.size() == 1);
    bool along_u = s.attributes[0].uv0[1].x != s.attributes[0].uv0[0].x;
    glm::vec2 at = s.attributes[0].uv0[0];
    auto reflectance = [&](double x) {
        double t = at.x == 0 ? x : 1 - x;
        return surface_reflectance(s, 0, along_u ? t : 0.5, along_u ? 0.5 : t);
    };
    CHECK(reflectance(0.25)[0] == doctest::Approx(0.5));
    CHECK(reflectance(0.25)[1] == doctest::Approx(0));
    CHECK(reflectance(0.75)[1] == doctest::Approx(0.5 * 0.502886).epsilon(1e-4));
    CHECK(reflectance(0.5)[1] == doctest::Approx(0.25 * 0.502886).epsilon(1e-4));

    // A picture that is not there leaves the factor and a warning.
    file.more = R"(, "textures": [{"source": 0}], "images": [{"uri": "none.png"}])";
    s = load_scene(file.write(folder));
    CHECK(s.warnings.size() == 1);
    CHECK(surface_reflectance(s, 0, 0.3, 0.3)[1] == 0.5f);
}

// Fails when a mirrored node keeps its winding, or translation is scaled.
TEST_CASE("glTF nodes, cameras and lights") {
    TestFolder folder;
    SquareGltf file;
    file.node = R"({"children": [1, 2], "scale": [2, 2, 2], "translation": [0, 0, 1]},
        {"mesh": 0, "scale": [-1, 1, 1]},
        {"camera": 0, "translation": [0, 0, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}})";
    file.more = R"(, "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1,
        "zfar": 9, "znear": 0}}], "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 7, "color": [1, 0.5, 0], "range": 3,
         "spot": {"outerConeAngle": 0.5}}]}})";
    LoadSettings settings;
    settings.scale = 10;
    Scene s = load_scene(file.write(folder), settings);
    REQUIRE(s.surfaces.size() == 1);
    CHECK(surface_area(s, s.surfaces[0]) == doctest::Approx(400));
    CHECK(surface_normal(s, s.surfaces[0]).z == doctest::Approx(1));
    CHECK(scene_bounds(s).low.x == doctest::Approx(-20));
    CHECK(scene_bounds(s).low.z == doctest::Approx(10));
    REQUIRE(s.cameras.size() == 1);
    CHECK(s.cameras[0].position.z == doctest::Approx(70));
    CHECK(s.cameras[0].forward.z == doctest::Approx(-1));
    CHECK(s.cameras[0].orthographic_height == doctest::Approx(20));
    CHECK(s.cameras[0].aspect == doctest::Approx(2));
    REQUIRE(s.lights.size() == 1);
    CHECK(s.lights[0].kind == Light::Kind::spot);
    CHECK(s.lights[0].intensity[1] == doctest::Approx(3.5));
    CHECK(s.lights[0].range == doctest::Approx(30));
}

// Fails when spans, indices, extensions or numbers are believed.
TEST_CASE("broken glTF is refused with its place") {
    TestFolder folder;
    SquareGltf file;
    CHECK(fault_of(file.write(folder)) == "");
    auto fault = [&](auto&& change) {
        SquareGltf broken;
        change(broken);
        return fault_of(broken.write(folder));
    };
    CHECK(holds(fault([](auto& f) { f.count = "5"; }), "/accessors/0: needs 60 bytes"));
    CHECK(holds(fault([](auto& f) { f.count = "4000000000"; }), "/accessors/0: needs"));
    CHECK(holds(fault([](auto& f) { f.count = "3"; }), "index 5 is 3, but there are 3 vertices"));
    CHECK(holds(fault([](auto& f) { f.count = "-1"; }), "/accessors/0/count"));
    CHECK(holds(fault([](auto& f) { f.buffer = R"("uri": "gone.bin", )"; }), "no such file"));
    CHECK(holds(fault([](auto& f) { f.buffer = R"("uri": "../x.bin", )"; }), "leads out"));
    CHECK(holds(fault([](auto& f) { f.buffer = ""; }), "/buffers/0"));
    CHECK(holds(fault([](auto& f) {
                    f.more = R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])";
                }),
                "KHR_draco_mesh_compression is required and not supported"));
    CHECK(holds(fault([](auto& f) { f.node = R"({"mesh": 0, "children": [0]})"; }), "cycles"));
    CHECK(holds(fault([](auto& f) { f.node = R"({"mesh": 0, "scale": [1, 1, 1e300]})"; }),
                "/nodes/0/scale/2"));
    CHECK(holds(fault([](auto& f) { f.material = R"({"emissiveFactor": [-1, 0, 0]})"; }),
                "/materials/0/emissiveFactor/0"));
    CHECK(holds(fault([](auto& f) { f.material = R"({"name": 7})"; }), "/materials/0/name"));
}

// Fails when any read is not checked against what is left of the file.
TEST_CASE("files cut anywhere are refused") {
    TestFolder folder;
    SquareGltf file;
    file.buffer = "";
    std::string glb = glb_of(file.json(), square_bytes());
    CHECK(fault_of(folder.write("whole.glb", glb)) == "");
    for (std::size_t n = 0; n < glb.size(); ++n) {
        CAPTURE(n);
        CHECK(fault_of(folder.write("cut.glb", glb.substr(0, n))) != "");
    }
    std::string stl(80, ' ');
    put(stl, 2u);
    for (int facet = 0; facet < 2; ++facet) {
        for (float x : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, float(facet)})
            put(stl, x);
        stl += std::string(2, '\0');
    }
    CHECK(fault_of(folder.write("whole.stl", stl)) == "");
    for (std::size_t n = 0; n < stl.size(); ++n)
        CHECK(fault_of(folder.write("cut.stl", stl.substr(0, n))) != "");
}

// Fails when the word "solid" decides, or a solid's end is not its object's.
TEST_CASE("STL, binary and ASCII") {
    TestFolder folder;
    std::string binary = "solid, but binary";
    binary.resize(80, ' ');
    put(binary, 1u);
    for (float x : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f})
        put(binary, x);
    binary += std::string(2, '\0');
    Scene s = load_scene(folder.write("b.stl", binary));
    REQUIRE(s.surfaces.size() == 1);
    CHECK(surface_area(s, s.surfaces[0]) == 3);
    CHECK_FALSE(s.materials[0].two_sided);

    std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex +1 0 0\n"
        "vertex 0 1e0 0\nendloop\nendfacet\n";
    s = load_scene(folder.write(
        "a.stl", "solid one\n" + facet + "endsolid one\nsolid two\n" + facet + "endsolid"));
    CHECK(s.objects == std::vector<std::string>{"one", "two"});
    CHECK(s.surfaces.size() == 2);
    std::string fault = fault_of(
        folder.write("x.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 nought 0\n"));
    CHECK(holds(fault, "line 4: \"nought\" stands where a number must be"));
}

// Fails when indices are believed, negative ones are counted from the wrong end, or Ka emits.
TEST_CASE("OBJ and MTL") {
    TestFolder folder;
    folder.write("m.mtl",
                 "newmtl a b\nKd 0.2 0.4 0.6\nKa 9 9 9\nKe 1 2 3\nnewmtl white\nKd 1 1 1\n");
    std::string corners = "mtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";
    Scene s = load_scene(folder.write(
        "a.obj", corners + "usemtl a b\nf -4 -3 -2 -1\no back\nusemtl white\nf 4//1 3 \\\n2\n"));
    REQUIRE(s.surfaces.size() == 2);
    CHECK(surface_area(s, s.surfaces[0]) == 4);
    CHECK(surface_area(s, s.surfaces[1]) == 2);
    CHECK(surface_normal(s, s.surfaces[0]).z == 1);
    CHECK(surface_normal(s, s.surfaces[1]).z == -1);
    CHECK(surface_emission(s, 0, 0, 0)[2] == doctest::Approx(3 * pi));
    CHECK(surface_reflectance(s, 0, 0, 0)[1] == 0.4f);
    CHECK(surface_reflectance(s, 1, 0, 0)[1] == 0.999f);
    CHECK(s.materials[0].two_sided);
    CHECK(s.objects == std::vector<std::string>{"a", "back"});

    auto fault = [&](const std::string& text) { return fault_of(folder.write("x.obj", text)); };
    CHECK(holds(fault(corners + "f 1 2 5\n"), "line 6: vertex 5 is used, but there are 4"));
    CHECK(holds(fault(corners + "f 1 2 -5\n"), "line 6: vertex -5"));
    CHECK(holds(fault(corners + "f 1 2 0\n"), "line 6: vertex 0"));
    CHECK(holds(fault(corners + "f 1 2 99999999999999999999\n"), "is no index"));
    CHECK(holds(fault(corners + "f 1/1 2/1 3/1\n"), "texture coordinate 1"));
    CHECK(holds(fault("v 0 nan 0\n"), "line 1: \"nan\" is no number"));
    CHECK(holds(fault("mtllib ../m.mtl\nf 1 2 3\n"), "line 1: \"../m.mtl\" leads out"));
    s = load_scene(folder.write("y.obj", "mtllib gone.mtl\n" + corners.substr(14) + "f 1 2 3\n"));
    CHECK(s.warnings.size() == 1);
    CHECK(surface_reflectance(s, 0, 0, 0)[0] == 0.5f);
}

// Fails when the content no longer decides where the ending says nothing.
TEST_CASE("formats are known by content") {
    TestFolder folder;
    std::string obj = "# c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    CHECK(fault_of(folder.write("obj.data", obj)) == "");
    SquareGltf file;
    file.buffer = "";
    CHECK(fault_of(folder.write("glb", glb_of(file.json(), square_bytes()))) == "");
    CHECK(holds(fault_of(folder.write("x.ply", "ply\nformat ascii 1.0\n")),
                "scenes are read from glTF (.gltf, .glb), OBJ, STL and Parallux JSON"));
    CHECK(holds(fault_of(folder.write("empty.xyz", "")), "unknown format"));
    CHECK(holds(fault_of(folder.path() / "absent.gltf"), "no such file"));
    CHECK(holds(fault_of(folder.write("bell\a.obj", "v 0\n")), "bell?.obj"));
}
