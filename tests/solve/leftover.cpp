#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "parallux/solve.h"
#include "random.h"
#include "solve/follow.h"
#include "support/hand_made.h"
#include "support/seeds.h"

using namespace parallux;
using namespace parallux::test;

namespace {

// Lines within some rooms of regions, few from room to room, and some out of the scene.
struct Rooms {
    static constexpr std::uint32_t rooms = 6, in_room = 40, regions = rooms * in_room, bands = 2;
    Eigen::MatrixXd lines = Eigen::MatrixXd::Zero(regions, regions);
    Eigen::VectorXd exits = Eigen::VectorXd::Zero(regions);
    std::vector<double> reflectance, unshot;
    std::vector<std::uint32_t> room;

    Rooms() {
        Random random(3, 1);
        auto below = [&](std::uint32_t n) {
            return static_cast<std::uint32_t>(random.uniform() * n);
        };
        for (int line = 0; line < 8000; ++line) {
            const std::uint32_t a = below(regions);
            std::uint32_t b = a / in_room * in_room + below(in_room);
            if (line % 400 == 0)
                b = below(regions);
            ++lines(a, b);
            ++lines(b, a);
            ++exits[a];
            ++exits[b];
            if (line % 500 == 0)
                ++exits[below(regions)];
        }
        for (std::uint32_t k = 0; k < regions; ++k) {
            room.push_back(k / in_room);
            for (std::uint32_t band = 0; band < bands; ++band) {
                reflectance.push_back(band == 0 ? 0.999 : k % 7 == 0 ? 0 : 0.6);
                unshot.push_back(k < in_room ? random.uniform() : 0);
            }
        }
    }

    RegionWays ways() const {
        RegionWays ways;
        ways.start.push_back(0);
        for (std::uint32_t from = 0; from < regions; ++from) {
            for (std::uint32_t to = 0; to < regions; ++to)
                ways.to.insert(ways.to.end(), std::size_t(lines(from, to)), to);
            ways.start.push_back(static_cast<std::uint32_t>(ways.to.size()));
            ways.exits.push_back(static_cast<std::uint32_t>(exits[from]));
        }
        return ways;
    }

    GroupWays group_ways() const {
        GroupWays ways{rooms, std::vector<std::uint32_t>(rooms * rooms, 0),
                       std::vector<std::uint32_t>(rooms, 0)};
        for (std::uint32_t from = 0; from < regions; ++from) {
            ways.exits[room[from]] += static_cast<std::uint32_t>(exits[from]);
            for (std::uint32_t to = 0; to < regions; ++to)
                ways.lines[room[from] * rooms + room[to]] +=
                    static_cast<std::uint32_t>(lines(from, to));
        }
        return ways;
    }
};

// x = N (u + ρ x) / n, densely.
Eigen::VectorXd dense(const Eigen::MatrixXd& lines, const Eigen::VectorXd& exits,
                      const Eigen::VectorXd& reflectance, const Eigen::VectorXd& unshot) {
    const Eigen::MatrixXd way = lines * exits.cwiseInverse().asDiagonal();
    const Eigen::Index n = exits.size();
    return (Eigen::MatrixXd::Identity(n, n) - way * reflectance.asDiagonal())
        .partialPivLu()
        .solve(way * unshot);
}

Eigen::VectorXd of_band(const std::vector<double>& values, std::uint32_t bands,
                        std::uint32_t band) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(values.size() / bands));
    for (Eigen::Index k = 0; k < result.size(); ++k)
        result[k] = values[static_cast<std::size_t>(k) * bands + band];
    return result;
}

GroupSystem group_system(const Rooms& rooms) {
    std::vector<double> reflectance(rooms.rooms * rooms.bands, 0);
    for (std::size_t k = 0; k < rooms.reflectance.size(); ++k)
        reflectance[rooms.room[k / rooms.bands] * rooms.bands + k % rooms.bands] +=
            rooms.reflectance[k] / rooms.in_room;
    return {rooms.group_ways(), reflectance, rooms.bands, 1};
}

}  // namespace

TEST_CASE("light is followed between groups and between regions as a dense solution has it") {
    // To rounding between groups; between regions to some thousandths of all that comes.
    // Fails (planted, seen) when a tenth of the first bounce is lost between regions.
    const Rooms rooms;
    const GroupSystem groups = group_system(rooms);
    std::vector<double> sums(rooms.rooms * rooms.bands, 0), mean(sums.size(), 0);
    for (std::size_t k = 0; k < rooms.unshot.size(); ++k) {
        sums[rooms.room[k / 2] * 2 + k % 2] += rooms.unshot[k];
        mean[rooms.room[k / 2] * 2 + k % 2] += rooms.reflectance[k] / rooms.in_room;
    }
    const GroupWays between = rooms.group_ways();
    Eigen::MatrixXd lines(rooms.rooms, rooms.rooms);
    Eigen::VectorXd exits(rooms.rooms);
    for (std::uint32_t a = 0; a < rooms.rooms; ++a) {
        exits[a] = between.exits[a];
        for (std::uint32_t b = 0; b < rooms.rooms; ++b)
            lines(a, b) = between.lines[a * rooms.rooms + b];
    }
    const std::vector<double> none(rooms.unshot.size(), 0), coarse = groups.follow(sums);
    const std::vector<double> fine = follow(rooms.ways(), rooms.reflectance, rooms.unshot, none,
                                            rooms.bands, rooms.room, groups, 1);
    for (std::uint32_t band = 0; band < rooms.bands; ++band) {
        CAPTURE(band);
        const Eigen::VectorXd expected =
            dense(lines, exits, of_band(mean, 2, band), of_band(sums, 2, band));
        CHECK((of_band(coarse, 2, band) - expected).norm() < 1e-9 * expected.norm());
        const Eigen::VectorXd exact =
            dense(rooms.lines, rooms.exits, of_band(rooms.reflectance, 2, band),
                  of_band(rooms.unshot, 2, band));
        CHECK((of_band(fine, 2, band) - exact).norm() < 0.005 * exact.norm());
    }
    for (unsigned threads : {2u, 7u})
        CHECK(follow(rooms.ways(), rooms.reflectance, rooms.unshot, none, rooms.bands, rooms.room,
                     groups, threads) == fine);
}

TEST_CASE("light is followed where it is dim beside a bright place") {
    // A lamp's inside, bright and soon even, and a gap in a row of 40 regions, white, whose light,
    // a millionth of the lamp's, comes in at one end and goes from each to the next alone. Seen
    // with a criterion in the energy of the whole: the far half of the gap was dark, and a
    // room above a lamp 9 % too dark.
    // Fails (planted, seen) when Settled adds up all groups.
    constexpr std::uint32_t row = 40, n = 2 * row;
    Eigen::MatrixXd lines = Eigen::MatrixXd::Zero(n, n);
    for (std::uint32_t k = 0; k + 1 < row; ++k)
        lines(k, k + 1) = lines(k + 1, k) = 32;
    lines.bottomRightCorner(row, row).setConstant(2);
    const Eigen::VectorXd exits = lines.rowwise().sum();
    RegionWays ways;
    ways.start.push_back(0);
    GroupWays between{2, {0, 0, 0, 0}, {0, 0}};
    std::vector<std::uint32_t> group;
    for (std::uint32_t from = 0; from < n; ++from) {
        group.push_back(from / row);
        for (std::uint32_t to = 0; to < n; ++to)
            ways.to.insert(ways.to.end(), std::size_t(lines(from, to)), to);
        ways.start.push_back(static_cast<std::uint32_t>(ways.to.size()));
        ways.exits.push_back(static_cast<std::uint32_t>(exits[from]));
        between.lines[group[from] * 3] += ways.exits[from];
        between.exits[group[from]] += ways.exits[from];
    }
    const std::vector<double> reflectance(n, 0.999), none(n, 0);
    std::vector<double> unshot(n, 0);
    unshot[0] = 1;
    unshot[row] = 1e6;
    const GroupSystem groups(between, {0.999, 0.999}, 1, 1);
    const std::vector<double> found = follow(ways, reflectance, unshot, none, 1, group, groups, 1);
    const Eigen::VectorXd exact =
        dense(lines, exits, of_band(reflectance, 1, 0), of_band(unshot, 1, 0));
    for (std::uint32_t first : {0u, row})
        CHECK((of_band(found, 1, 0) - exact).segment(first, row).norm() <
              0.005 * exact.segment(first, row).norm());
}

TEST_CASE("light in a white hollow behind a slit is right after fewer bundles than it bounces") {
    // A flat box of reflectance 0.99, two thirds of a metre wide and 4 cm high, open at one narrow
    // side: light stays for some fifty bounces, 64 bundles carry it over thirty. Against counts of
    // 2^24 independent lines, solved whole: off by less than the standard error of eight such
    // groups. Fails when light is even within groups (seen: 14 % low) and when the
    // first 32 bundles alone are kept (seen: 3 % high).
    Scene scene = room({grey(0.5, 1), grey(0.5), grey(0.5), grey(0.5), grey(0.5), grey(0.5)}, 4);
    const auto white = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(grey(0.99, 0, true));
    add_box(
        scene,
        [](glm::dvec3 p) { return glm::dvec3(0.2, 0.2, 0.5) + glm::dvec3(0.66, 0.66, 0.04) * p; },
        false, 6, {white, white, white, white, white, white});
    scene.surfaces.erase(scene.surfaces.begin() + 6);  // the side towards the lamp
    const Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.first_shot = FirstShot::off;
    settings.method = Method::matrix;
    settings.lines = 1 << 24;
    const Solution exact = solve(scene, patches, settings);
    settings = SolveSettings();
    settings.first_shot = FirstShot::off;
    settings.groups = 1;
    settings.bundles = 64 * 2;
    const int seeds = 256;
    Sample inside;
    auto mean_inside = [&](const std::vector<float>& radiosity) {
        double sum = 0, area = 0;
        for (std::size_t s = 6; s < scene.surfaces.size(); ++s)
            for (std::uint32_t cell = 0; cell < 36; ++cell) {
                const std::uint32_t patch = patches.grids[s].back + cell;
                sum += patches.area[patch] * radiosity[patch];
                area += patches.area[patch];
            }
        return sum / area;
    };
    for (const std::vector<float>& run : runs(scene, patches, settings, seeds, 1))
        inside.add(mean_inside(run));
    const double truth = mean_inside(exact.radiosity);
    const double of_eight = std::sqrt(inside.variance() / 8);
    MESSAGE("inside ", truth, ", runs ", inside.mean(), ", standard error of eight ", of_eight);
    CHECK(std::fabs(inside.mean() - truth) < of_eight);
}
