#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

#include "glb.h"
#include "hand_made.h"
#include "output/atlas.h"
#include "output/bake_values.h"
#include "parallux/parallux.h"
#include "random.h"

// Lightmaps. Cases name the planted errors that were seen to fail them.

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

std::string temporary(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("parallux_lightmap_" + name)).string();
}

// A room's corner of three walls, a fin with two sides and two triangles.
Case corner(const hand_made::Field& field) {
    Case c;
    c.scene.bands = 3;
    Spectrum red;
    red[0] = 0.75f, red[1] = 0.25f, red[2] = 0.125f;
    c.material(red);
    c.material(Spectrum::constant(0.5f), true);
    c.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 9, 7);
    c.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4}, 7, 5);
    c.quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0}, 5, 9);
    c.quad({2, 1, 1}, {0, 2, 0}, {0, 0, 2}, 3, 4, 1);
    c.triangle({1, 0.5, 3}, {3, 0.5, 3}, {1, 2, 3.5}, 5, 1);
    c.triangle({3, 3, 3}, {3.1, 3, 3}, {3, 3.1, 3}, 1);
    c.divide(field);
    return c;
}

double plane(const dvec3& p, const dvec3& n) {
    return 20 + p.x - 2 * p.y + 3 * p.z + 10 * n.x + 5 * n.z;
}

// A picture in memory, as a file or a lightmap has it.
struct Picture3 {
    int width = 0, height = 0;
    std::vector<float> values;

    explicit Picture3(const Lightmap& map)
        : width(int(map.width)), height(int(map.height)), values(map.values) {}
    explicit Picture3(const std::string& file) {
        auto input = OIIO::ImageInput::open(file);
        REQUIRE(input);
        width = input->spec().width, height = input->spec().height;
        REQUIRE(input->spec().channelnames == std::vector<std::string>{"R", "G", "B"});
        values.resize(std::size_t(3) * width * height);
        REQUIRE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, values.data()));
    }

    float at(int x, int y, int b) const {
        x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
        return values[3 * (std::size_t(y) * width + x) + b];
    }

    // As a renderer filters it.
    double bilinear(glm::dvec2 uv, int b) const {
        double x = uv.x * width - 0.5, y = uv.y * height - 0.5;
        int i = int(std::floor(x)), j = int(std::floor(y));
        double s = x - i, t = y - j;
        return (1 - t) * ((1 - s) * at(i, j, b) + s * at(i + 1, j, b)) +
               t * ((1 - s) * at(i, j + 1, b) + s * at(i + 1, j + 1, b));
    }

    // The next mip level: means of two by two.
    Picture3 half() const {
        Picture3 result = *this;
        result.width = width / 2, result.height = height / 2;
        for (int y = 0; y < result.height; ++y)
            for (int x = 0; x < result.width; ++x)
                for (int b = 0; b < 3; ++b)
                    result.values[3 * (std::size_t(y) * result.width + x) + b] =
                        (at(2 * x, 2 * y, b) + at(2 * x + 1, 2 * y, b) + at(2 * x, 2 * y + 1, b) +
                         at(2 * x + 1, 2 * y + 1, b)) /
                        4;
        return result;
    }
};

// Texture coordinates of a point of the mesh in a file.
struct MeshUv {
    test::Glb glb;
    explicit MeshUv(const std::string& file) : glb(file) {}

    bool find(const dvec3& point, const dvec3& normal, glm::dvec2& uv) const {
        bool found = false;
        glb.triangles([&](const auto& attributes, const auto& v) {
            auto p = glb.values<glm::vec3>(attributes["POSITION"]);
            auto t = glb.values<glm::vec2>(attributes["TEXCOORD_1"]);
            dvec3 a = p[v[0]], ab = dvec3(p[v[1]]) - a, ac = dvec3(p[v[2]]) - a;
            dvec3 n = glm::cross(ab, ac);
            if (glm::dot(glm::normalize(n), normal) < 0.999 ||
                std::abs(glm::dot(glm::normalize(n), point - a)) > 1e-5)
                return;
            double s = glm::dot(glm::cross(point - a, ac), n) / glm::dot(n, n);
            double r = glm::dot(glm::cross(ab, point - a), n) / glm::dot(n, n);
            if (s < -1e-6 || r < -1e-6 || s + r > 1 + 1e-6)
                return;
            found = true;
            uv = (1 - s - r) * glm::dvec2(t[v[0]]) + s * glm::dvec2(t[v[1]]) +
                 r * glm::dvec2(t[v[2]]);
        });
        return found;
    }
};

}  // namespace

// Planted: texture coordinates half a texel off; a flat cell that takes its neighbour's value.
TEST_CASE("a lightmap looked up at cells' centres gives the patches' values") {
    Case c = corner(plane);
    std::vector<PatchPlace> places = patch_places(c.scene, c.patches);
    for (bool flat : {false, true})
        for (std::uint32_t size : {0u, 64u}) {
            CAPTURE(flat);
            CAPTURE(size);
            LightmapSettings settings;
            settings.flat = flat, settings.size = size;
            Lightmap map = make_lightmap(c.scene, c.patches, c.solution, settings);
            if (size > 0)
                CHECK((map.width == size && map.height == size));
            write_lightmap(temporary("c.exr"), c.scene, map);
            Picture3 picture(temporary("c.exr"));
            MeshUv mesh(temporary("c.glb"));
            CHECK(mesh.glb.json["asset"]["extras"]["lightmap"]["uri"] == "parallux_lightmap_c.exr");
            Random random(7, 1);
            int sampled = 0;
            while (sampled < 50) {
                auto patch = static_cast<std::size_t>(random.uniform() * double(places.size()));
                const PatchPlace& place = places[patch];
                bool triangle = c.scene.surfaces[place.surface].shape() == Shape::triangle;
                // Flat, two cells of a triangle share a texel; scaled, texels lie elsewhere.
                if (flat && (triangle || size > 0)) {
                    if (size > 0)
                        break;
                    continue;
                }
                ++sampled;
                glm::dvec2 uv;
                REQUIRE(mesh.find(place.centre, place.normal, uv));
                for (int b = 0; b < 3; ++b)
                    CHECK(picture.bilinear(uv, b) ==
                          doctest::Approx(c.solution.radiosity[3 * patch + b]).epsilon(2e-5));
            }
        }
    std::filesystem::remove(temporary("c.exr"));
    std::filesystem::remove(temporary("c.glb"));
}

// Planted: padding of one texel only; odd chart positions; shelves two texels too high up, so that
// charts overlap.
TEST_CASE("no filter and no mip level reaches a foreign texel") {
    for (bool flat : {false, true})
        for (std::uint32_t size : {0u, 47u, 128u}) {
            CAPTURE(flat);
            CAPTURE(size);
            Case c;
            c.scene.bands = 3;
            c.material(Spectrum::constant(0.5f), true);
            // Each side of each surface has a value of its own.
            for (std::uint32_t n = 1; n < 6; ++n) {
                double x = 10.0 * n;
                c.quad({x, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, 2 * n);
                c.triangle({x + 2, 0, 0}, {x + 2, 0, 1}, {x + 2, 1, 0}, n);
            }
            c.divide([&](const dvec3& p, const dvec3& n) {
                return std::floor(p.x) + (n.x + n.z > 0 ? 0.5 : 0.25);
            });
            LightmapSettings settings;
            settings.flat = flat, settings.size = size;
            Lightmap map = make_lightmap(c.scene, c.patches, c.solution, settings);
            Picture3 picture(map), half = picture.half();
            std::vector<int> owner(std::size_t(map.width) * map.height, -1);
            for (std::size_t k = 0; k < map.charts.size(); ++k) {
                const Chart& chart = map.charts[k];
                CHECK((chart.x % 2 == 0 && chart.y % 2 == 0));
                REQUIRE(chart.x >= 2);
                REQUIRE(chart.y >= 2);
                REQUIRE(chart.x + chart.width + 2 <= map.width);
                REQUIRE(chart.y + chart.height + 2 <= map.height);
                const SurfaceGrid& grid = c.patches.grids[chart.surface];
                float value =
                    c.solution.radiosity[3 * std::size_t(chart.back ? grid.back : grid.front)];
                for (std::uint32_t y = chart.y - 2; y < chart.y + chart.height + 2; ++y)
                    for (std::uint32_t x = chart.x - 2; x < chart.x + chart.width + 2; ++x) {
                        int& o = owner[std::size_t(y) * map.width + x];
                        CHECK(o == -1);
                        o = int(k);
                        CHECK(picture.at(int(x), int(y), 0) == doctest::Approx(value));
                    }
                // The corners of the chart's own coordinates, in the picture and its next level.
                double edge = flat ? 0 : 0.5;
                for (double u : {chart.x + edge, chart.x + chart.width - edge})
                    for (double v : {chart.y + edge, chart.y + chart.height - edge}) {
                        glm::dvec2 uv(u / map.width, v / map.height);
                        CHECK(picture.bilinear(uv, 0) == doctest::Approx(value));
                        if (map.width % 2 == 0 && map.height % 2 == 0)
                            CHECK(half.bilinear(uv, 0) == doctest::Approx(value));
                    }
            }
        }
}

// Planted: the lit side of a wall taken.
TEST_CASE("no light comes through under a wall that stands between cells") {
    Case c;
    c.scene.bands = 3;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true);
    c.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 16, 16);
    c.quad({0, -2, 0}, {0, 4, 0}, {0, 0, 2}, 8, 4, 1);
    c.divide([](const dvec3& p, const dvec3&) { return p.x < 0 ? 8.0 : 0.0; });
    Lightmap map = make_lightmap(c.scene, c.patches, c.solution, {});
    Picture3 picture(map);
    const Chart& floor = map.charts[0];
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 17; ++x)
            CHECK(picture.at(int(floor.x) + x, int(floor.y) + y, 0) == (x < 8 ? 4 : 0));
}

// Planted: the scene's whole path in the header.
TEST_CASE("the header names quantity, unit and scene, and equal lightmaps are equal files") {
    Case c = corner(plane);
    c.scene.file = "/somewhere/room.gltf";
    LightmapSettings one, three;
    one.threads = 1, three.threads = 3;
    for (Quantity q : {Quantity::irradiance, Quantity::radiance}) {
        one.quantity = three.quantity = q;
        write_lightmap(temporary("1.exr"), c.scene,
                       make_lightmap(c.scene, c.patches, c.solution, one));
        std::string picture = test::bytes_of(temporary("1.exr"));
        std::string mesh = test::bytes_of(temporary("1.glb"));
        write_lightmap(temporary("1.exr"), c.scene,
                       make_lightmap(c.scene, c.patches, c.solution, three));
        CHECK(picture == test::bytes_of(temporary("1.exr")));
        CHECK(mesh == test::bytes_of(temporary("1.glb")));
        auto input = OIIO::ImageInput::open(temporary("1.exr"));
        REQUIRE(input);
        CHECK(input->spec().get_string_attribute("quantity") == quantity_name(q));
        CHECK(input->spec().get_string_attribute("unit") == quantity_unit(q));
        CHECK(input->spec().get_string_attribute("scene") == "room.gltf");
        CHECK(input->spec().get_string_attribute("DateTime") == "1970:01:01 00:00:00");
    }
    std::filesystem::remove(temporary("1.exr"));
    std::filesystem::remove(temporary("1.glb"));
}

// Planted: the least grids never tried, so that a picture too small is written overlapping.
TEST_CASE("a lightmap too small for its charts is refused") {
    Case c = corner(plane);
    LightmapSettings settings;
    settings.size = 12;
    CHECK_THROWS_AS(make_lightmap(c.scene, c.patches, c.solution, settings), Error);
}

// Planted: coordinates of the wrong set; a texel that takes its last triangle's value in place of
// its nearest one's.
TEST_CASE("a scene's own second texture coordinates are used when asked for") {
    // A packed lightmap's mesh is a scene with such coordinates.
    Case c = corner(plane);
    LightmapSettings settings;
    settings.size = 128;
    write_lightmap(temporary("o.exr"), c.scene,
                   make_lightmap(c.scene, c.patches, c.solution, settings));
    MeshUv mesh(temporary("o.glb"));
    CHECK_THROWS_AS(
        [&] {
            LightmapSettings own;
            own.own_uv = true;
            make_lightmap(c.scene, c.patches, c.solution, own);
        }(),
        Error);
    LoadSettings load;
    load.lightmap_uv = true;
    Case loaded;
    loaded.scene = load_scene(temporary("o.glb"), load);
    CHECK(loaded.scene.lightmap_uv.size() == loaded.scene.surfaces.size());
    for (Surface& s : loaded.scene.surfaces)
        s.grid_u = s.grid_v = 4;
    loaded.divide(plane);
    settings.own_uv = true;
    Picture3 picture(make_lightmap(loaded.scene, loaded.patches, loaded.solution, settings));
    std::vector<PatchPlace> places = patch_places(loaded.scene, loaded.patches);
    Random random(9, 1);
    for (int sample = 0; sample < 50; ++sample) {
        auto patch = static_cast<std::size_t>(random.uniform() * double(places.size()));
        glm::dvec2 uv;
        REQUIRE(mesh.find(places[patch].centre, places[patch].normal, uv));
        for (int b = 0; b < 3; ++b)
            CHECK(picture.bilinear(uv, b) ==
                  doctest::Approx(loaded.solution.radiosity[3 * patch + b]).epsilon(1e-4));
    }
    // Two objects in one place of the picture are refused.
    loaded.scene.lightmap_uv[1] = loaded.scene.lightmap_uv[0];
    CHECK_THROWS_AS(make_lightmap(loaded.scene, loaded.patches, loaded.solution, settings), Error);
    std::filesystem::remove(temporary("o.exr"));
    std::filesystem::remove(temporary("o.glb"));
}
