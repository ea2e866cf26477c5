#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lines/directions.h"
#include "lines/ray_scene.h"
#include "parallux/lines.h"
#include "random.h"
#include "solve/emitters.h"
#include "support/hand_made.h"
#include "support/statistics.h"

// How lines lie: by χ² over cells of equal probability, and by Crofton's formulas.

using namespace parallux;
using namespace parallux::test;

namespace {

// Counts in cells of equal probability.
class Cells {
public:
    explicit Cells(std::size_t side) : side_(side), counts_(side * side, 0) {}

    /// Both uniform in [0, 1].
    void add(double a, double b) {
        ++counts_[place(a) * side_ + place(b)];
        ++draws_;
    }
    /// χ² in standard deviations from its mean; the draws must be independent.
    double excess() const {
        const auto cells = static_cast<double>(counts_.size());
        const double expected = draws_ / cells, freedom = cells - 1;
        double chi = 0;
        for (double count : counts_)
            chi += (count - expected) * (count - expected) / expected;
        return (chi - freedom) / std::sqrt(2 * freedom);
    }
    double draws() const { return draws_; }

private:
    std::size_t place(double x) const {
        return std::min(side_ - 1, static_cast<std::size_t>(x * double(side_)));
    }

    std::size_t side_;
    double draws_ = 0;
    std::vector<double> counts_;
};

double turn_of(double y, double x) {
    return std::atan2(y, x) / (2 * pi) + 0.5;
}

// Of 10⁴ cells χ² is as good as normal: beyond 4.5 once in 300 000 times.
constexpr double bound = 4.5;

}  // namespace

// Planted, seen: tests/planted/cosine_law.patch.
TEST_CASE("local rays leave by the cosine law") {
    Random random(7, 2);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, -3));
    glm::dvec3 x, y;
    frame_across(normal, x, y);
    Cells cells(100);
    for (int k = 0; k < 2'000'000; ++k) {
        const double a = random.uniform(), b = random.uniform();
        const glm::dvec3 d = cosine_direction(normal, a, b);
        const double cosine = glm::dot(d, normal);
        cells.add(cosine * cosine, turn_of(glm::dot(d, y), glm::dot(d, x)));
    }
    CHECK(std::fabs(cells.excess()) < bound);
}

TEST_CASE("where lines hit a patch: places uniform, cos² uniform") {
    // A line meets a plate with probability ∝ |cos θ|: among hits cos² θ is uniform, and so are
    // azimuth and place. Planted, seen: tests/planted/disc_radius.patch.
    Scene scene;
    scene.bands = 1;
    scene.materials = {grey(0.5, 0, true)};
    scene.objects = {"plate"};
    add_quad(scene, {-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
    scene.surfaces[0].grid_u = scene.surfaces[0].grid_v = 40;
    const Patches patches = make_patches(scene);
    const RayScene rays(scene, 1);
    const LineSphere sphere = line_sphere(scene, 1);
    IntersectionLists lists;
    std::vector<glm::dvec3> directions;
    Cells places(40), angles(40);
    for (std::uint64_t batch = 0; batch < 100; ++batch) {
        trace_lines(rays, scene, patches, sphere, 3, batch * 20000, 20000, lists, &directions);
        for (std::size_t line = 0; line < lists.lines(); ++line)
            for (std::uint32_t k = lists.start[line]; k < lists.start[line + 1]; ++k) {
                const std::uint32_t cell = std::min(lists.hits[k].toward, lists.hits[k].away);
                places.add((cell % 40 + 0.5) / 40, (cell / 40 % 40 + 0.5) / 40);
                const glm::dvec3& d = directions[line];
                angles.add(d.z * d.z, turn_of(d.y, d.x));
            }
    }
    CHECK(places.draws() > 250'000);
    CHECK(std::fabs(places.excess()) < bound);
    CHECK(std::fabs(angles.excess()) < bound);
}

// The lines of one bundle are not independent of each other: one is looked at of each.
// Planted, seen: tests/planted/squeezed_bundles.patch, offset.patch.
TEST_CASE("bundles: places uniform, cos² uniform") {
    Cells angles(40), places(40);
    for (std::uint64_t k = 0; k < 1'000'000; ++k) {
        const Bundle bundle = make_bundle({8, 1'000'000, DirectionSet::random, 1}, k);
        // The line through the cell about the origin meets a plate across z as often as |cos θ|.
        const double cosine = std::fabs(bundle.direction.z);
        if (Random(9, k).uniform() >= cosine)
            continue;
        angles.add(cosine * cosine, turn_of(bundle.direction.y, bundle.direction.x));
        places.add(bundle.offset_x, bundle.offset_y);
    }
    CHECK(std::fabs(angles.excess()) < bound);
    CHECK(std::fabs(places.excess()) < bound);
}

// Planted, seen: tests/planted/stretched.patch.
TEST_CASE(
    "bundles through a solid that is not convex: mean chord 4 V / S, crossings as Crofton's") {
    // An L of volume 3 and surface 14, whose faces are met by A |cos θ| / δ² lines of a bundle,
    // A / (2 δ²) in the mean: chords have the mean 4 V / S, whatever the directions.
    const Scene scene = l_room(grey(0.5), grey(0.5), 1);
    const Patches patches = make_patches(scene);
    const Projector projector(scene, patches);
    auto workspace = projector.make_workspace();
    Projection projection;
    IntersectionLists lists;
    Sample inside, crossings;
    const double spacing = 0.05;
    for (std::uint64_t k = 0; k < 400; ++k) {
        projector.project(make_bundle({4, 400, DirectionSet::random, spacing}, k), projection);
        double length = 0, hits = 0;
        for (std::size_t tile = 0; tile < projection.tiles(); ++tile) {
            projector.lists(projection, tile, *workspace, lists);
            hits += double(lists.hits.size());
            for (std::size_t line = 0; line < lists.lines(); ++line)
                for (std::uint32_t h = lists.start[line]; h + 1 < lists.start[line + 1]; h += 2)
                    length += double(lists.hits[h + 1].depth) - lists.hits[h].depth;
        }
        inside.add(length * projector.radius());
        crossings.add(hits);
    }
    const double volume = 3, surface = 14;
    CHECK(std::fabs(inside.z(volume / (spacing * spacing))) < 4);
    CHECK(std::fabs(crossings.z(surface / (2 * spacing * spacing))) < 4);
    CHECK(2 * inside.mean() / crossings.mean() ==
          doctest::Approx(4 * volume / surface).epsilon(0.02));
}
