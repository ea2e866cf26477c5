#include <cmath>
#include <filesystem>
#include <set>

#include <doctest/doctest.h>

#include "glb.h"
#include "hand_made.h"
#include "output/bake_values.h"
#include "parallux/parallux.h"
#include "support/hand_made.h"

// Vertex colours. Cases name the planted errors that were seen to fail them.

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

std::string temporary(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("parallux_bake_" + name)).string();
}

// A floor, a wall that meets it, a fin with two sides, and a triangle in the air; light depends on
// the place and on the way a surface looks.
Case corner_with_fin() {
    Case c;
    c.scene.bands = 3;
    Spectrum red;
    red[0] = 0.75f, red[1] = 0.25f, red[2] = 0.125f;
    c.material(red);
    c.material(Spectrum::constant(0.5f), true, Spectrum::constant(2));
    c.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 8, 8);
    c.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4}, 8, 8);
    c.quad({2, 1, 1}, {0, 2, 0}, {0, 0, 2}, 4, 4, 1);
    c.triangle({1, 0, 3}, {3, 0, 3}, {1, 2, 3.5}, 5, 1);
    c.divide([](const dvec3& p, const dvec3& n) {
        return 20 + p.x - 2 * p.y + 3 * p.z + 10 * n.x + 5 * n.z;
    });
    return c;
}

// Where a point of a face with this normal lies on the scene's surfaces.
struct Place {
    std::uint32_t surface = none;
    bool back = false;
    double u = 0, v = 0;
};

Place find(const Scene& scene, const dvec3& middle, const dvec3& point, const dvec3& normal) {
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        dvec3 n = surface_normal(scene, surface), p0 = scene.positions[surface.corner[0]];
        dvec3 a = scene.positions[surface.corner[1]] - p0;
        dvec3 b = scene.positions[surface.corner_v()] - p0, axb = glm::cross(a, b);
        auto u = [&](const dvec3& p) {
            return glm::dot(glm::cross(p - p0, b), axb) / glm::dot(axb, axb);
        };
        auto v = [&](const dvec3& p) {
            return glm::dot(glm::cross(a, p - p0), axb) / glm::dot(axb, axb);
        };
        double mu = u(middle), mv = v(middle);
        bool within = mu > 0 && mv > 0 && mu < 1 && mv < 1 &&
                      (surface.shape() == Shape::parallelogram || mu + mv < 1);
        if (std::abs(glm::dot(middle - p0, n)) < 1e-5 && std::abs(glm::dot(n, normal)) > 0.999 &&
            within)
            return {s, glm::dot(n, normal) < 0, u(point), v(point)};
    }
    return {};
}

// Every corner of every triangle of a loaded bake against the interpolated values.
void compare(const Case& c, const Scene& baked, const BakeSettings& settings, double exposure) {
    BakeValues values(c.scene, c.patches, c.solution, settings);
    std::set<std::pair<std::uint32_t, bool>> met;
    for (std::size_t t = 0; t < baked.surfaces.size(); ++t) {
        const Surface& triangle = baked.surfaces[t];
        dvec3 middle(0), normal = surface_normal(baked, triangle);
        for (int k = 0; k < 3; ++k)
            middle += baked.positions[triangle.corner[k]] / 3.0;
        for (int k = 0; k < 3; ++k) {
            Place at = find(c.scene, middle, baked.positions[triangle.corner[k]], normal);
            REQUIRE(at.surface != none);
            met.insert({at.surface, at.back});
            float expected[max_bands];
            // A little inwards, so that flat cells are the triangle's own.
            Place in = find(c.scene, middle, middle, normal);
            double e = settings.flat ? 0.5 : 0;
            values.at(at.surface, at.back, at.u + e * (in.u - at.u), at.v + e * (in.v - at.v),
                      expected);
            for (int b = 0; b < 3; ++b)
                CHECK(baked.attributes[t].colour[k][b] ==
                      doctest::Approx(exposure * expected[b]).epsilon(1e-5));
        }
    }
    CHECK(met.size() == 6);  // four fronts, two backs
}

// What COLOR_0 is the quantity times of.
double exposure_in(const std::string& file) {
    const std::string bytes = test::bytes_of(file), key = "\"exposure\":";
    REQUIRE(bytes.find(key) != std::string::npos);
    return std::stod(bytes.substr(bytes.find(key) + key.size(), 40));
}

LoadSettings triangles() {
    LoadSettings settings;
    settings.keep_triangles = true;
    return settings;
}

}  // namespace

// Planted: backs with the front's values; one face for both sides whatever their values.
TEST_CASE("a bake read back by the scene loader has the interpolated values at its vertices") {
    Case c = corner_with_fin();
    for (std::string name : {"a.glb", "a.gltf"})
        for (BakeMesh mesh : {BakeMesh::original, BakeMesh::patches})
            for (Quantity quantity :
                 {Quantity::irradiance, Quantity::radiosity, Quantity::radiance}) {
                BakeSettings settings;
                settings.mesh = mesh, settings.quantity = quantity;
                Bake bake = make_bake(c.scene, c.patches, c.solution, settings);
                write_bake(temporary(name), c.scene, bake);
                Scene loaded = load_scene(temporary(name), triangles());
                CHECK(loaded.surfaces.size() ==
                      (mesh == BakeMesh::original ? 10 : 2 * (64 + 64 + 16 + 16) + 25 + 25));
                compare(c, loaded, settings, exposure_in(temporary(name)));
                std::filesystem::remove(temporary(name));
            }
}

// Planted: vertices shared by place and normal alone, so that the wall's other side shines through.
TEST_CASE("no colour runs under a wall from one surface to the next") {
    Case c;
    c.scene.bands = 3;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true);
    c.quad({-2, -2, 0}, {2, 0, 0}, {0, 4, 0}, 4, 8);
    c.quad({0, -2, 0}, {2, 0, 0}, {0, 4, 0}, 4, 8);
    c.quad({0, -2, 0}, {0, 4, 0}, {0, 0, 2}, 8, 4, 1);
    c.divide([](const dvec3& p, const dvec3& n) { return p.x < 0 || n.x < 0 ? 8.0 : 0.0; });
    for (BakeMesh mesh : {BakeMesh::original, BakeMesh::patches}) {
        BakeSettings settings;
        settings.mesh = mesh;
        Bake bake = make_bake(c.scene, c.patches, c.solution, settings);
        for (const BakePart& part : bake.parts)
            for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
                float middle = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    middle += bake.positions[part.first_vertex + part.indices[i + k]].x;
                bool floor = part.material == 0;
                for (std::size_t k = 0; k < 3 && floor; ++k)
                    CHECK(bake.colours[part.first_vertex + part.indices[i + k]].x ==
                          (middle < 0 ? 4 : 0));
            }
    }
}

// Planted: a flat cell that takes the value of the one before it.
TEST_CASE("flat patches keep their own values") {
    Case c = corner_with_fin();
    BakeSettings settings;
    settings.mesh = BakeMesh::patches, settings.flat = true;
    // Faces come in the order of the patches where material and object are one.
    Bake bake = make_bake(c.scene, c.patches, c.solution, settings);
    REQUIRE(bake.parts.size() == 2);
    for (std::uint32_t cell = 0; cell < 128; ++cell)
        for (std::uint32_t k = 0; k < 6; ++k)
            for (int b = 0; b < 3; ++b)
                CHECK(bake.colours[bake.parts[0].indices[6 * cell + k]][b] ==
                      c.solution.radiosity[3 * cell + b]);
    write_bake(temporary("f.glb"), c.scene, make_bake(c.scene, c.patches, c.solution, settings));
    compare(c, load_scene(temporary("f.glb"), triangles()), settings,
            exposure_in(temporary("f.glb")));
    std::filesystem::remove(temporary("f.glb"));
}

// Planted: one face for both sides whatever their values.
TEST_CASE("a two-sided surface is one face with equal sides, two with different ones") {
    Case c;
    c.scene.bands = 1;
    c.material(Spectrum::constant(0.5f), true);
    c.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
    c.divide([](const dvec3&, const dvec3&) { return 4.0; });
    Bake bake = make_bake(c.scene, c.patches, c.solution, {});
    REQUIRE(bake.parts.size() == 1);
    CHECK(bake.parts[0].both_sides);
    CHECK(bake.parts[0].indices.size() == 6);
    CHECK(bake.colours.at(0) == glm::vec3(2));
    c.divide([](const dvec3&, const dvec3& n) { return n.z > 0 ? 4.0 : 1.0; });
    bake = make_bake(c.scene, c.patches, c.solution, {});
    REQUIRE(bake.parts.size() == 1);
    CHECK(!bake.parts[0].both_sides);
    CHECK(bake.parts[0].indices.size() == 12);
}

// Planted: the factor of radiance on radiosity; no clamp; the quantity left out of the extras.
TEST_CASE("an unlit bake is exposed and clamped, and says so") {
    Case c = corner_with_fin();
    for (Quantity quantity : {Quantity::irradiance, Quantity::radiosity, Quantity::radiance}) {
        BakeSettings settings;
        settings.quantity = quantity;
        Bake raw = make_bake(c.scene, c.patches, c.solution, settings);
        settings.unlit = true;
        settings.exposure = 1.5;
        Bake bake = make_bake(c.scene, c.patches, c.solution, settings);
        write_bake(temporary("u.glb"), c.scene, bake);
        test::Glb glb(temporary("u.glb"));
        const auto& extras = glb.json["asset"]["extras"];
        CHECK(extras["quantity"] == quantity_name(quantity));
        CHECK(extras["unit"] == quantity_unit(quantity));
        CHECK(extras["colour_space"] == "linear Rec.709");
        CHECK(extras["clamped"] == true);
        CHECK(glb.json["extensionsUsed"] == nlohmann::json({"KHR_materials_unlit"}));
        CHECK(glb.json["materials"][0]["extensions"].contains("KHR_materials_unlit"));
        double factor = extras["exposure"];
        bool unclamped = false, clamped = false;
        // Where both sides are clamped to white, one face and fewer vertices are left.
        for (std::size_t v = 0; v < bake.colours.size(); ++v) {
            bool found = false;
            for (std::size_t r = 0; r < raw.colours.size(); ++r) {
                glm::vec3 wanted = glm::min(float(factor) * raw.colours[r], 1.0f);
                (wanted.x < 1 ? unclamped : clamped) = true;
                found = found || (bake.positions[v] == raw.positions[r] &&
                                  glm::distance(bake.colours[v], wanted) < 1e-5f);
            }
            CHECK(found);
        }
        CHECK(unclamped);
        CHECK(clamped);
        std::filesystem::remove(temporary("u.glb"));
    }
    // One radiance is one colour, however it is asked for.
    BakeSettings a, b;
    a.unlit = b.unlit = true;
    b.quantity = Quantity::radiance;
    Bake one = make_bake(c.scene, c.patches, c.solution, a);
    Bake other = make_bake(c.scene, c.patches, c.solution, b);
    for (std::size_t v = 0; v < one.colours.size(); ++v)
        CHECK(one.colours[v].x == doctest::Approx(other.colours[v].x).epsilon(1e-5));
}

// Planted, seen to fail: a log-mean of all that has any light, in which 1e-9 weighs as ten times
// what lies between sun and shade.
TEST_CASE("the exposure of an unlit bake is of what is lit, not of glints on outer walls") {
    Case c = corner_with_fin();
    BakeSettings settings;
    settings.unlit = true;
    const std::size_t dark = c.solution.radiosity.size() / 3;
    auto exposure_with = [&](float glint) {
        std::fill_n(c.solution.radiosity.begin(), dark, glint);
        return make_bake(c.scene, c.patches, c.solution, settings).factor;
    };
    CHECK(exposure_with(1e-9f) == doctest::Approx(exposure_with(0)).epsilon(1e-12));
}

// Planted: colours before normals.
TEST_CASE("PLY holds the same vertices and triangles") {
    Case c = corner_with_fin();
    Bake bake = make_bake(c.scene, c.patches, c.solution, {});
    write_bake(temporary("p.ply"), c.scene, bake);
    test::Ply ply(temporary("p.ply"));
    CHECK(ply.header.find("comment quantity radiosity\ncomment unit W/m2\n") != std::string::npos);
    REQUIRE(ply.vertices.size() == bake.positions.size());
    for (std::size_t v = 0; v < ply.vertices.size(); ++v)
        for (int k = 0; k < 3; ++k) {
            CHECK(ply.vertices[v][k] == bake.positions[v][k]);
            CHECK(ply.vertices[v][3 + k] == bake.normals[v][k]);
            CHECK(ply.vertices[v][6 + k] == bake.colours[v][k]);
        }
    std::size_t face = 0;
    for (const BakePart& part : bake.parts)
        for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3, ++face)
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(ply.faces.at(face)[k] == part.first_vertex + part.indices[i + k]);
    CHECK(face == ply.faces.size());
    std::filesystem::remove(temporary("p.ply"));
}

// Planted: backs with the front's values; padding that nobody fills. An error that nobody planted:
// exact first shots lit the inside through the walls (see tests/solve/determinism.cpp).
TEST_CASE("a closed box in a lit world is exactly black inside, on every output") {
    Scene scene = test::room(test::grey(0.5, 10), 6, dvec3(-2), dvec3(2));
    scene.bands = 3;
    test::add_turned_cube(scene, dvec3(0.1, 0.2, 0.1), 1, 4, test::grey(0.7, 0, true));
    Patches patches = make_patches(scene);
    SolveSettings run;
    run.bundles = 200, run.threads = 2;
    Solution solution = solve(scene, patches, run);
    for (const SurfaceGrid& grid : patches.grids)
        if (grid.back != none)
            for (std::uint32_t cell = 0; cell < grid.nu * grid.nv; ++cell)
                REQUIRE(solution.irradiance[3 * std::size_t(grid.back + cell)] == 0);
    std::uint64_t lit = 0, dark = 0;
    for (BakeMesh mesh : {BakeMesh::original, BakeMesh::patches})
        for (Quantity quantity : {Quantity::irradiance, Quantity::radiosity}) {
            BakeSettings settings;
            settings.mesh = mesh, settings.quantity = quantity;
            Bake bake = make_bake(scene, patches, solution, settings);
            write_bake(temporary("d.glb"), scene, bake);
            write_bake(temporary("d.ply"), scene, bake);
            auto check = [&](const std::array<dvec3, 3>& p, const std::array<glm::vec3, 3>& c) {
                dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
                dvec3 out = p[0] - dvec3(0.1, 0.2, 0.1);
                bool inside = glm::length(out) < 1 && glm::dot(n, out) < 0;
                for (const glm::vec3& colour : c) {
                    (inside ? dark : lit) += 1;
                    CHECK((colour == glm::vec3(0)) == inside);
                }
            };
            test::Glb glb(temporary("d.glb"));
            glb.triangles([&](const auto& attributes, const auto& v) {
                auto p = glb.values<glm::vec3>(attributes["POSITION"]);
                auto c = glb.values<glm::vec3>(attributes["COLOR_0"]);
                check({dvec3(p[v[0]]), dvec3(p[v[1]]), dvec3(p[v[2]])},
                      {c[v[0]], c[v[1]], c[v[2]]});
            });
            test::Ply ply(temporary("d.ply"));
            for (const auto& face : ply.faces) {
                std::array<dvec3, 3> p;
                std::array<glm::vec3, 3> c;
                for (int k = 0; k < 3; ++k) {
                    const auto& v = ply.vertices.at(face[k]);
                    p[k] = {v[0], v[1], v[2]}, c[k] = {v[6], v[7], v[8]};
                }
                check(p, c);
            }
        }
    CHECK(dark == 4 * (36 + 6 * 16 * 6));
    CHECK(lit > dark);
    for (bool flat : {false, true}) {
        LightmapSettings settings;
        settings.flat = flat;
        Lightmap map = make_lightmap(scene, patches, solution, settings);
        std::uint64_t black = 0;
        for (const Chart& chart : map.charts) {
            bool inside = chart.back;
            for (std::uint32_t y = chart.y - 2; y < chart.y + chart.height + 2; ++y)
                for (std::uint32_t x = chart.x - 2; x < chart.x + chart.width + 2; ++x)
                    for (std::uint32_t b = 0; b < map.bands; ++b) {
                        float value = map.values[(std::size_t(y) * map.width + x) * map.bands + b];
                        CHECK((value == 0) == inside);
                        black += value == 0;
                    }
        }
        CHECK(black > 0);
    }
    std::filesystem::remove(temporary("d.glb"));
    std::filesystem::remove(temporary("d.ply"));
}
