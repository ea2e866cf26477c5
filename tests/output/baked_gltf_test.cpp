#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "glb.h"
#include "hand_made.h"
#include "parallux/parallux.h"
#include "random.h"

// What glTF asks of bakes, and the scene's pictures in them. Cases name the planted errors that
// were seen to fail them.

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

std::string temporary(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("parallux_gltf_" + name)).string();
}

// Levels that 8 bits of sRGB hold; brighter ones for lights.
Texture picture(std::uint64_t seed, float scale) {
    Texture texture;
    texture.name = "picture", texture.width = 4, texture.height = 3;
    Random random(seed, 1);
    for (int i = 0; i < 12; ++i) {
        glm::vec3 texel;
        for (int b = 0; b < 3; ++b) {
            const double x = std::floor(256 * random.uniform()) / 255;
            texel[b] = scale * float(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
        }
        texture.texels.push_back(texel);
    }
    texture.texels[0] = glm::vec3(scale);  // what becomes white
    return texture;
}

// A floor with a picture, a wall with vertex colours, a screen whose picture has coordinates of its
// own and shines.
Case pictures() {
    Case c;
    c.scene.bands = 3;
    Spectrum red;
    red[0] = 0.75f, red[1] = 0.5f, red[2] = 0.25f;
    c.material(red);
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.25f), false, Spectrum::constant(4));
    c.scene.textures = {picture(1, 1), picture(2, 3)};
    c.scene.materials[0].reflectance_texture = 0;
    c.scene.materials[2].reflectance_texture = 0;
    c.scene.materials[2].emission_texture = 1, c.scene.materials[2].emission_uv = 1;
    c.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 6, 6);
    c.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4}, 6, 6, 1);
    c.triangle({1, 1, 3}, {3, 1, 3}, {1, 2, 3}, 4, 2);
    c.scene.attributes.resize(3);
    for (SurfaceAttributes& a : c.scene.attributes) {
        a.uv0 = {glm::vec2(0.1f, 0.2f), glm::vec2(1.3f, 0.3f), glm::vec2(0.2f, 0.9f)};
        a.uv1 = {glm::vec2(0), glm::vec2(0.75f, 0), glm::vec2(0, 0.5f)};
    }
    c.scene.attributes[1].colour = {glm::vec3(1), glm::vec3(0.5f, 1, 0.25f), glm::vec3(1, 0.5f, 1)};
    c.divide([](const dvec3& p, const dvec3& n) { return 20 + p.x - p.y + 2 * p.z + 5 * n.z; });
    return c;
}

}  // namespace

// Planted: no scale; the largest colour's own inverse as the scale, which rounds.
TEST_CASE(
    "COLOR_0 lies within 0 and 1, and divided by the exposure it is the quantity to the bit") {
    for (float brightness : {0.015f, 1.0f, 40000.0f}) {
        Case c = pictures();
        for (float& h : c.solution.irradiance)
            h *= brightness;
        Bake bake = make_bake(c.scene, c.patches, c.solution, {.quantity = Quantity::irradiance});
        write_bake(temporary("e.glb"), c.scene, bake);
        test::Glb glb(temporary("e.glb"));
        const double exposure = glb.json["asset"]["extras"]["exposure"];
        CHECK((brightness < 0.1f) == (exposure == 1));
        CHECK(std::exp2(std::round(std::log2(exposure))) == exposure);
        std::size_t v = 0;
        float most = 0;
        for (const auto& mesh : glb.json["meshes"])
            for (const auto& primitive : mesh["primitives"]) {
                CHECK(primitive["extras"]["exposure"] == exposure);
                for (const glm::vec3& colour :
                     glb.values<glm::vec3>(primitive["attributes"]["COLOR_0"])) {
                    CHECK(colour / float(exposure) == bake.colours.at(v++));
                    most = std::max({most, colour.x, colour.y, colour.z});
                }
            }
        CHECK(v == bake.colours.size());
        CHECK(most <= 1);
        CHECK(most > (exposure == 1 ? 0 : 0.5));
    }
    std::filesystem::remove(temporary("e.glb"));
}

// Planted: the picture left in the colours as well, so that it would count twice; the picture of
// the lamp kept, which would tint what it emits.
TEST_CASE("baked colours times the picture that glTF carries are what is seen") {
    Case c = pictures();
    for (Quantity quantity : {Quantity::radiosity, Quantity::radiance})
        for (const char* name : {"t.glb", "t.gltf"}) {
            BakeSettings settings;
            settings.quantity = quantity;
            const Bake plain = make_bake(c.scene, c.patches, c.solution, settings);
            settings.textures = true;
            write_bake(temporary(name), c.scene,
                       make_bake(c.scene, c.patches, c.solution, settings));
            LoadSettings load;
            load.keep_triangles = true;
            const Scene seen = load_scene(temporary(name), load);
            REQUIRE(seen.textures.size() == 1);  // the lamp's stays baked
            const std::string bytes = test::bytes_of(temporary(name));
            const double exposure = std::stod(bytes.substr(bytes.find("\"exposure\":") + 11, 40));
            // The loader multiplies as viewers do: factor, picture, vertex colour.
            std::size_t pictured = 0;
            for (std::uint32_t s = 0; s < seen.surfaces.size(); ++s) {
                const bool kept =
                    seen.materials[seen.surfaces[s].material].reflectance_texture != none;
                pictured += kept;
                const glm::dvec2 corners[3] = {{0, 0}, {1, 0}, {0, 1}};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Spectrum look = surface_reflectance(seen, s, corners[k].x, corners[k].y);
                    const dvec3 at = seen.positions[seen.surfaces[s].corner[k]];
                    double nearest = 1e9;
                    for (std::size_t v = 0; v < plain.positions.size(); ++v)
                        if (glm::distance(dvec3(plain.positions[v]), at) < 1e-5 &&
                            std::abs(glm::dot(dvec3(plain.normals[v]),
                                              surface_normal(seen, seen.surfaces[s]))) > 0.99) {
                            double off = 0;
                            for (int b = 0; b < 3; ++b)
                                off = std::max(off, std::abs(look[std::size_t(b)] / exposure -
                                                             plain.colours[v][b]) /
                                                        plain.colours[v][b]);
                            nearest = std::min(nearest, off);
                        }
                    CHECK(nearest < 2e-3);  // reflectance 1 becomes 0.999 in loading
                }
            }
            CHECK(pictured == 2);
            std::filesystem::remove(temporary(name));
        }
}

// Planted: the emission's strength without the picture's brightest value; the second coordinates
// not written; pictures as linear levels.
TEST_CASE("a lightmap's mesh has the scene's own look") {
    Case c = pictures();
    write_lightmap(temporary("l.exr"), c.scene, make_lightmap(c.scene, c.patches, c.solution, {}));
    const Scene seen = load_scene(temporary("l.glb"));
    REQUIRE(seen.surfaces.size() == 3);
    REQUIRE(seen.textures.size() == 2);
    Random random(3, 1);
    for (std::uint32_t s = 0; s < 3; ++s)
        for (int sample = 0; sample < 50; ++sample) {
            double u = random.uniform(), v = random.uniform();
            if (u + v > 1)
                u = 1 - u, v = 1 - v;
            // Surfaces and materials are in the same order; corners may begin elsewhere.
            const dvec3 at = surface_point(c.scene, c.scene.surfaces[s], u, v);
            const std::uint32_t twin = [&] {
                for (std::uint32_t t = 0; t < 3; ++t)
                    if ((seen.materials[seen.surfaces[t].material].emission == Spectrum{}) ==
                            (s != 2) &&
                        std::abs(glm::dot(at - seen.positions[seen.surfaces[t].corner[0]],
                                          surface_normal(seen, seen.surfaces[t]))) < 1e-6 &&
                        seen.surfaces[t].shape() == c.scene.surfaces[s].shape())
                        return t;
                return none;
            }();
            REQUIRE(twin != none);
            const Surface& t = seen.surfaces[twin];
            const dvec3 p0 = seen.positions[t.corner[0]];
            const dvec3 a = seen.positions[t.corner[1]] - p0, b = seen.positions[t.corner_v()] - p0;
            const dvec3 n = glm::cross(a, b);
            const double tu = glm::dot(glm::cross(at - p0, b), n) / glm::dot(n, n);
            const double tv = glm::dot(glm::cross(a, at - p0), n) / glm::dot(n, n);
            const Spectrum rho = surface_reflectance(c.scene, s, u, v);
            const Spectrum rho_seen = surface_reflectance(seen, twin, tu, tv);
            const Spectrum e = surface_emission(c.scene, s, u, v);
            const Spectrum e_seen = surface_emission(seen, twin, tu, tv);
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(rho_seen[k] == doctest::Approx(rho[k]).epsilon(1e-4));
                CHECK(e_seen[k] == doctest::Approx(e[k]).epsilon(1e-4));
            }
        }
    std::filesystem::remove(temporary("l.exr"));
    std::filesystem::remove(temporary("l.glb"));
}
