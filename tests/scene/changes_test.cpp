#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "parallux/changes.h"
#include "parallux/error.h"
#include "support/hand_made.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Scene painted() {
    std::array<Material, 6> faces;
    for (int k = 0; k < 6; ++k) {
        faces[k] = grey(0.5, k);
        faces[k].name = k < 3 ? "wall" : "face " + std::to_string(k);
    }
    Scene scene = room(faces, 1);
    scene.bands = 3;
    scene.materials[5].reflectance[1] = 0.25f;
    return scene;
}

void with_table(Scene& scene, const std::string& text, std::uint32_t bands = 0) {
    std::string pattern = (std::filesystem::temp_directory_path() / "parallux-XXXXXX").string();
    close(mkstemp(pattern.data()));
    std::ofstream(pattern, std::ios::binary) << text;
    try {
        set_materials(scene, pattern, bands);
    } catch (...) {
        std::filesystem::remove(pattern);
        throw;
    }
    std::filesystem::remove(pattern);
}

Fault refusal(const std::string& text, std::uint32_t bands = 0) {
    Scene scene = painted();
    try {
        with_table(scene, text, bands);
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.fault();
    }
    return Fault{};
}

}  // namespace

// Planted, seen: values of one band put into the next; textures that go on multiplying.
TEST_CASE("a table gives materials their values by name, others keep theirs") {
    Scene scene = painted();
    scene.textures.push_back({"grey", 1, 1, {glm::vec3(0.5f)}});
    scene.materials[0].reflectance_texture = 0;
    scene.attributes.resize(6);
    for (SurfaceAttributes& a : scene.attributes)
        a.colour.fill(glm::vec3(0.5f));
    with_table(scene, "material,reflectance_r,reflectance_g,reflectance_b\nwall,0.1,0.2,0.3\r\n");
    CHECK(scene.bands == 3);
    for (int k = 0; k < 3; ++k) {
        CHECK(surface_reflectance(scene, std::uint32_t(k), 0.5, 0.5)[1] == 0.2f);
        CHECK(scene.materials[k].emission[2] == float(k));
    }
    CHECK(surface_reflectance(scene, 3, 0.5, 0.5)[1] == 0.25f);
    CHECK(scene.warnings.size() == 1);
}

// Planted, seen: a material that is not in the table left with values for three bands.
TEST_CASE("eight bands need eight values of all that is not the same in all bands") {
    const std::string header =
        "material,reflectance_0,reflectance_1,reflectance_2,reflectance_3,reflectance_4,"
        "reflectance_5,reflectance_6,reflectance_7\n";
    const std::string row = ",0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8\n";
    Scene scene = painted();
    with_table(scene, header + "\"face 5\"" + row + "wall" + row);
    CHECK(scene.bands == 8);
    CHECK(surface_reflectance(scene, 5, 0, 0)[7] == 0.8f);
    CHECK(surface_reflectance(scene, 4, 0, 0)[7] == 0.5f);
    CHECK(scene.materials[5].emission[7] == 5);
    CHECK(refusal(header + "wall" + row) == Fault::input);  // face 5 has a colour of its own
    CHECK(refusal(header + "face 5" + row, 4) == Fault::usage);
    CHECK(refusal(header + "face 5" + row, 8) == Fault{});
    Scene again = painted();
    CHECK_THROWS_AS(set_bands(again, 5), Error);
    again.surfaces.pop_back();
    set_bands(again, 5);
    CHECK(again.materials[4].reflectance[4] == 0.5f);
    CHECK(again.materials[4].reflectance[5] == 0);
}

TEST_CASE("what is no such table is refused") {
    for (const char* text :
         {"", "material\nwall\n", "reflectance_0\n0.5\n", "material,reflectance_1\nwall,0.5\n",
          "material,reflectance_0,transmittance_0\nwall,0.5,0.5\n",
          "material,reflectance_0,colour\nwall,0.5,red\n", "material,reflectance_8\nwall,0.5\n",
          "material,reflectance_r\nwall,0.5\n", "material,reflectance_0\nwall,1\n",
          "material,reflectance_0\nwall,-0.1\n", "material,reflectance_0\nwall,nan\n",
          "material,reflectance_0\nwall,\n", "material,reflectance_0\nwall\n",
          "material,reflectance_0\nnobody,0.5\n", "material,reflectance_0\nwall,0.5\nwall,0.5\n",
          "material,reflectance_0,reflectance_0\nwall,0.5,0.5\n",
          "material,reflectance_0\n\"wall,0.5\n",
          "material,reflectance_0,emission_0,emission_1\nwall,0.5,1,1\n"}) {
        CAPTURE(std::string(text));
        CHECK(refusal(text) == Fault::input);
    }
}

TEST_CASE("names with * and ?, and what they leave out") {
    CHECK(name_fits("wall north", "wall*"));
    CHECK(name_fits("wall north", "*o*h"));
    CHECK(name_fits("wall", "w?ll"));
    CHECK(name_fits("", "*"));
    CHECK(!name_fits("wall", "wal"));
    CHECK(!name_fits("wall", "*walls"));
    CHECK(!name_fits("wall", ""));
    Scene scene = painted();
    exclude_surfaces(scene, {"wall", "face 4"});
    REQUIRE(scene.surfaces.size() == 2);
    CHECK(scene.materials[scene.surfaces[1].material].name == "face 5");
    CHECK_THROWS_AS(exclude_surfaces(scene, {"nobody"}), Error);
    CHECK_THROWS_AS(exclude_surfaces(scene, {"*"}), Error);
}

// Planted, seen: coordinates left with the surfaces that had them before.
TEST_CASE("surfaces keep their own lightmap coordinates when others are left out") {
    Scene scene = painted();
    for (int k = 0; k < 5; ++k)  // the last has none
        scene.lightmap_uv.push_back(
            {glm::vec2(float(k)), glm::vec2(float(k)), glm::vec2(float(k))});
    exclude_surfaces(scene, {"wall"});
    REQUIRE(scene.surfaces.size() == 3);
    REQUIRE(scene.lightmap_uv.size() == 3);
    CHECK(scene.lightmap_uv[0][0].x == 3);
    CHECK(scene.lightmap_uv[1][0].x == 4);
    CHECK(scene.lightmap_uv[2][0].x != scene.lightmap_uv[2][0].x);
}
