#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include <glm/geometric.hpp>

#include "audit.h"
#include "support/hand_made.h"

// Lines where rasterisers leak: parity over more than ten million of them in all.

using namespace parallux;
using namespace parallux::test;

namespace {

using Map = std::function<glm::dvec3(const glm::dvec3&)>;

// A solid box whose faces are grids of n × n quads or of twice as many triangles, corners shared.
void add_grid_box(Scene& scene, const Map& map, std::uint32_t n, bool triangles) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const std::uint32_t side = n + 1;
    for (std::uint32_t k = 0; k < side * side * side; ++k)
        scene.positions.push_back(
            map(glm::dvec3(k % side, k / side % side, k / side / side) / double(n)));
    Surface surface;
    surface.grid_u = surface.grid_v = 1;
    auto add = [&](const glm::uvec3& p, unsigned u, unsigned v) {
        auto at = [&](unsigned du, unsigned dv) {
            glm::uvec3 q = p;
            q[u] += du, q[v] += dv;
            return first + q.x + side * (q.y + side * q.z);
        };
        surface.corner = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        if (!triangles)
            return scene.surfaces.push_back(surface);
        const auto c = surface.corner;
        surface.corner = {c[0], c[1], c[2], none};
        scene.surfaces.push_back(surface);
        surface.corner = {c[0], c[2], c[3], none};
        scene.surfaces.push_back(surface);
    };
    for (unsigned axis = 0; axis < 3; ++axis)
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j) {
                const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
                glm::uvec3 p(0);
                p[u] = i, p[v] = j;
                add(p, v, u);  // looks down the axis
                p[axis] = n;
                add(p, u, v);
            }
}

Scene empty_scene() {
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(0.5)};
    scene.objects = {"solid"};
    return scene;
}

// Lines along axes and diagonals, on corners and beside them, and in any direction.
void audit_all(const Scene& scene, double size, Audit& sums) {
    REQUIRE(is_closed(scene));
    const Patches patches = make_patches(scene);
    const Projector projector(scene, patches);
    const double r = std::sqrt(0.5);
    const glm::dvec3 directions[] = {{1, 0, 0}, {0, 1, 0},  {0, 0, -1},
                                     {r, r, 0}, {0, r, -r}, {-r, 0, r}};
    for (const glm::dvec3& d : directions) {
        const glm::dvec3 x =
            d.x == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(-d.y, d.x, 0) / std::hypot(d.x, d.y);
        const Bundle along{d, x, glm::cross(d, x), size / 128, 0, 0};
        audit(projector, along, sums);
        Bundle beside = along;
        beside.spacing = size / 100;
        beside.offset_x = 0.5;
        audit(projector, beside, sums);
    }
    for (std::uint64_t k = 0; k < 16; ++k)
        audit(projector, make_bundle({5, 16, DirectionSet::random, size / 200}, k), sums);
}

}  // namespace

// Planted, seen: tests/planted/row_below.patch, edge_column.patch.
TEST_CASE("parity where lines leak: grids, corners, scales, far offsets, slivers, coplanar faces") {
    Audit all;
    auto one = [&](const std::string& what, double size, const Scene& scene, double turned = 0) {
        CAPTURE(what);
        Audit sums;
        audit_all(scene, size, sums);
        CAPTURE(sums.lines);
        CHECK(sums.odd == 0);
        CHECK(double(sums.out_of_turn) <= turned * double(sums.lines));
        CHECK(sums.disordered == 0);
        all.lines += sums.lines;
    };
    for (bool triangles : {false, true}) {
        for (double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
            Scene grid = empty_scene();
            add_grid_box(
                grid, [&](const glm::dvec3& p) { return scale * p; }, 16, triangles);
            one("a grid along the axes, of any scale", scale, grid);
        }
        Scene far = empty_scene();
        add_grid_box(
            far, [](const glm::dvec3& p) { return p + glm::dvec3(1e6, -3e5, 2e6); }, 16, triangles);
        one("a grid a million sides away", 1, far);
        for (double aspect : {1e3, 1e6}) {
            Scene thin = empty_scene();
            add_grid_box(
                thin, [&](const glm::dvec3& p) { return p * glm::dvec3(1, 1, 1 / aspect); }, 4,
                triangles);
            one("a sheet", 1, thin);
            Scene needle = empty_scene();
            add_grid_box(
                needle,
                [&](const glm::dvec3& p) { return p * glm::dvec3(1, 1 / aspect, 1 / aspect); }, 4,
                triangles);
            // A millionth of the length thick, its sides are one plane to depths as floats.
            one("a needle", 1, needle, aspect < 1e6 ? 0 : 1e-4);
        }
        Scene touching = empty_scene();
        for (int k = 0; k < 8; ++k)
            add_grid_box(
                touching,
                [&](const glm::dvec3& p) { return p + glm::dvec3(k & 1, k / 2 & 1, k / 4 & 1); }, 3,
                triangles);
        // Of lines that run in the very planes and edges where cubes meet, four of them in a
        // place, some go in and out of one in the wrong turn; the audit of random lines has none.
        one("cubes that stand on each other", 2, touching, 1e-3);
        Audit random;
        const Patches patches = make_patches(touching);
        const Projector projector(touching, patches);
        for (std::uint64_t k = 0; k < 16; ++k)
            audit(projector, make_bundle({6, 16, DirectionSet::random, 0.01}, k), random);
        CHECK(random.odd + random.out_of_turn + random.disordered == 0);
    }
    CHECK(all.lines > 10'000'000);
}
