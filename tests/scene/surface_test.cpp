#include <cmath>

#include <glm/geometric.hpp>

#include "scene/mesh_builder.h"
#include "scene_files.h"

using namespace parallux;

namespace {

// A regular grid of n × n unit squares in the plane z = 0, two triangles each, corners not shared.
Mesh square_grid(int n) {
    Mesh mesh;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            glm::dvec3 a(x, y, 0), b(x + 1, y, 0), c(x + 1, y + 1, 0), d(x, y + 1, 0);
            for (const glm::dvec3& p : {a, b, c, a, c, d}) {
                mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                mesh.positions.push_back(p);
            }
        }
    return mesh;
}

Scene scene_of(const Mesh& mesh, const LoadSettings& settings = {}) {
    Scene scene;
    scene.materials.emplace_back();
    scene.objects.emplace_back();
    SceneBuilder(scene, settings).add(mesh);
    return scene;
}

Mesh pair(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    Mesh mesh;
    mesh.positions = {a, b, c, d};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

}  // namespace

// Fails when neighbours are joined over any edge: the grid then falls into sheared pairs and odd
// triangles instead of its squares.
TEST_CASE("a grid of triangle pairs becomes its squares") {
    Scene scene = scene_of(square_grid(20));
    CHECK(scene.positions.size() == 21 * 21);
    CHECK(scene.surfaces.size() == 400);
    CHECK(parallelograms(scene) == 400);
    for (const Surface& s : scene.surfaces) {
        CHECK(surface_area(scene, s) == 1);
        glm::dvec3 u = surface_point(scene, s, 1, 0) - surface_point(scene, s, 0, 0);
        glm::dvec3 v = surface_point(scene, s, 0, 1) - surface_point(scene, s, 0, 0);
        CHECK(glm::dot(u, v) == 0);
        CHECK(surface_normal(scene, s).z == 1);
        CHECK(surface_point(scene, s, 1, 1) == scene.positions[s.corner[2]]);
    }
    LoadSettings keep;
    keep.keep_triangles = true;
    CHECK(scene_of(square_grid(20), keep).surfaces.size() == 800);
}

// Fails when the fourth corner, the winding or the attributes are not compared.
TEST_CASE("only parallelograms are joined") {
    glm::dvec3 a(0, 0, 0), b(2, 0, 0), c(2, 1, 0), d(0, 1, 0);
    CHECK(scene_of(pair(a, b, c, d)).surfaces.size() == 1);
    CHECK(scene_of(pair(a, b, c, glm::dvec3(0.1, 1, 0))).surfaces.size() == 2);
    CHECK(scene_of(pair(a, b, c, glm::dvec3(0, 1, 0.01))).surfaces.size() == 2);
    CHECK(scene_of(pair(a, b, c, glm::dvec3(0, 1, 1e-7))).surfaces.size() == 1);
    Mesh folded = pair(a, b, c, d);
    std::swap(folded.indices[4], folded.indices[5]);
    CHECK(scene_of(folded).surfaces.size() == 2);
    Mesh coloured = pair(a, b, c, d);
    coloured.colours = {glm::vec3(0), glm::vec3(0.5f), glm::vec3(1), glm::vec3(0.5f)};
    CHECK(scene_of(coloured).surfaces.size() == 1);
    CHECK(scene_of(coloured).attributes.size() == 1);
    coloured.colours[3] = glm::vec3(0.6f);
    CHECK(scene_of(coloured).surfaces.size() == 2);
}

// Fails when the test of area is absolute: it then drops or keeps by the file's unit.
TEST_CASE("faces without area are dropped at every scale") {
    for (double scale : {1e-6, 1.0, 1e6}) {
        Mesh mesh = pair(glm::dvec3(0), glm::dvec3(scale, 0, 0), glm::dvec3(2 * scale, 0, 0),
                         glm::dvec3(0, scale, 0));
        Scene scene = scene_of(mesh);
        CHECK(scene.triangles == 2);
        CHECK(scene.zero_area == 1);
        CHECK(scene.surfaces.size() == 1);
    }
    // A sliver of aspect 10⁶ is a face.
    Scene sliver = scene_of(
        pair(glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(1, 1e-6, 0), glm::dvec3(0, 1e-6, 0)));
    CHECK(sliver.zero_area == 0);
}

// Fails when ears are cut without looking for corners inside them.
TEST_CASE("a concave polygon keeps its area") {
    std::vector<glm::dvec3> p = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 4, 0},
                                 {3, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
    std::vector<std::uint32_t> ring = {0, 1, 2, 3, 4, 5, 6, 7}, indices;
    triangulate(p, ring, indices);
    REQUIRE(indices.size() == 18);
    double area = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        double z =
            glm::cross(p[indices[i + 1]] - p[indices[i]], p[indices[i + 2]] - p[indices[i]]).z;
        CHECK(z > 0);
        area += z / 2;
    }
    CHECK(area == doctest::Approx(10));
}

// Fails when the horizon is mixed by angle instead of its sine, or ground and sky change places.
TEST_CASE("skies") {
    Sky sky;
    CHECK(sky.radiance({0, 0, 1})[0] == 0);
    sky.kind = Sky::Kind::gradient;
    sky.zenith = Spectrum::constant(4);
    sky.horizon = Spectrum::constant(2);
    sky.ground = Spectrum::constant(1);
    CHECK(sky.radiance({0, 0, 1})[0] == 4);
    CHECK(sky.radiance({std::sqrt(0.75), 0, 0.5})[7] == doctest::Approx(3));
    CHECK(sky.radiance({0, 0, -1})[2] == 1);
    sky.kind = Sky::Kind::uniform;
    CHECK(sky.radiance({0, 0, -1})[0] == 4);
}

// Fails when the picture is mirrored or upside down.
TEST_CASE("a sky picture has north in its middle and east to the right of it") {
    Sky sky;
    sky.kind = Sky::Kind::image;
    sky.image.width = 4;
    sky.image.height = 2;
    sky.image.texels.assign(8, glm::vec3(0));
    for (int x = 0; x < 4; ++x)
        sky.image.texels[static_cast<std::size_t>(x)] = glm::vec3(float(x + 1), 0, 0);
    // Column centres lie at azimuths -135, -45, 45 and 135 degrees east of north (+y).
    double r = std::sqrt(0.5);
    auto at = [&](double east, double north) {
        return sky.radiance(glm::normalize(glm::dvec3(east, north, 100)))[0];
    };
    CHECK(at(-r, -r) == doctest::Approx(1));
    CHECK(at(-r, r) == doctest::Approx(2));
    CHECK(at(r, r) == doctest::Approx(3));
    CHECK(at(r, -r) == doctest::Approx(4));
    CHECK(sky.radiance({r, 0, -r})[0] == doctest::Approx(0));
}
