#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

#include "glb.h"
#include "hand_made.h"
#include "parallux/parallux.h"

// A lightmap for each object. Cases name the planted errors that were seen to fail them.

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

std::string temporary(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("parallux_object_" + name)).string();
}

// Three plates, each an object and all over its own picture; one object has no surface.
Case plates() {
    Case c;
    c.scene.bands = 3;
    c.material(Spectrum::constant(0.5f));
    c.scene.objects = {"Box 1", "empty", "box/1", "a"};
    for (std::uint32_t k = 0; k < 3; ++k) {
        c.quad({0, 0, double(k)}, {1, 0, 0}, {0, 1, 0}, 4, 4);
        c.scene.surfaces.back().object = k == 0 ? 0 : k + 1;
        c.scene.lightmap_uv.push_back(
            {glm::vec2(0.1f, 0.9f), glm::vec2(0.9f, 0.9f), glm::vec2(0.1f, 0.1f)});
    }
    c.divide([](const dvec3& p, const dvec3&) { return 10 + 100 * p.z + p.x; });
    return c;
}

LightmapSettings by_object() {
    LightmapSettings settings;
    settings.own_uv = settings.by_object = true, settings.size = 32;
    return settings;
}

}  // namespace

// Planted: every picture with the surfaces of all objects, which were then refused; the picture of
// the object before.
TEST_CASE("layouts of single objects may overlap: each has a picture of its own") {
    Case c = plates();
    LightmapSettings shared = by_object();
    shared.by_object = false;
    CHECK_THROWS_WITH_AS(make_lightmap(c.scene, c.patches, c.solution, shared),
                         doctest::Contains("--lightmap-uv objects"), Error);
    std::vector<std::uint32_t> objects;
    make_object_lightmaps(c.scene, c.patches, c.solution, by_object(), [&](const Lightmap& map) {
        const double z = double(objects.size());
        objects.push_back(map.object);
        REQUIRE((map.width == 32 && map.height == 32));
        // Over the middle of each plate, u from 0.1 to 0.9.
        for (std::uint32_t x = 8; x < 24; ++x) {
            const double u = ((x + 0.5) / 32 - 0.1) / 0.8;
            CHECK(map.values[3 * (16 * 32 + x)] ==
                  doctest::Approx(0.5 * (10 + 100 * z + u)).epsilon(1e-3));
        }
    });
    CHECK(objects == std::vector<std::uint32_t>{0, 2, 3});
    // Overlaps within one object are refused still.
    c.scene.surfaces[2].object = 2;
    CHECK_THROWS_WITH_AS(
        make_object_lightmaps(c.scene, c.patches, c.solution, by_object(), [](const Lightmap&) {}),
        doctest::Contains("box/1"), Error);
}

// Planted: names told apart by their bytes alone, so that two were one file where case is not
// told; the mesh's extras with the first picture for all.
TEST_CASE("each object's picture has a file that its mesh names") {
    Case c = plates();
    const auto files = object_lightmaps(temporary("m.exr"), c.scene);
    REQUIRE(files.size() == 4);
    CHECK(files[0] == temporary("m_Box_1.exr"));
    CHECK(files[2] == temporary("m_box_1_2.exr"));
    CHECK(files[3] == temporary("m_a.exr"));
    make_object_lightmaps(c.scene, c.patches, c.solution, by_object(), [&](const Lightmap& map) {
        write_lightmap_picture(files[map.object], c.scene, map);
        auto input = OIIO::ImageInput::open(files[map.object].string());
        REQUIRE(input);
        CHECK(input->spec().get_string_attribute("object") == c.scene.objects[map.object]);
        std::filesystem::remove(files[map.object]);
    });
    write_lightmap_mesh(temporary("m.glb"), c.scene, own_uv_mesh(c.scene, c.patches, by_object()),
                        files);
    test::Glb glb(temporary("m.glb"));
    REQUIRE(glb.json["meshes"].size() == 3);
    CHECK(!glb.json["asset"]["extras"].contains("lightmap"));
    for (const auto& mesh : glb.json["meshes"]) {
        const std::string wanted = mesh["name"] == "a"       ? "m_a.exr"
                                   : mesh["name"] == "box/1" ? "m_box_1_2.exr"
                                                             : "m_Box_1.exr";
        for (const auto& extras : {mesh["extras"], mesh["primitives"][0]["extras"]}) {
            CHECK(extras["lightmap"]["uri"] == "parallux_object_" + wanted);
            CHECK(extras["lightmap"]["texCoord"] == 1);
        }
    }
    std::filesystem::remove(temporary("m.glb"));
}
