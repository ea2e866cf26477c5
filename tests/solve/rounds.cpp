#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "parallux/solve.h"
#include "solve/foresight.h"
#include "solve/plan_lines.h"
#include "support/bare_room.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Foresight eight_groups(double fall) {
    Foresight known;
    known.relative_rms = 0.01;
    known.alike = 1e9;  // so many that the estimate is its own bound
    known.lines.assign(8, 1000);
    known.fall = fall;
    return known;
}

}  // namespace

// Planted, seen to fail: the degrees of freedom of the groups to come left out.
TEST_CASE("the error to come: closed forms") {
    for (double fall : {0.5, 0.6, 0.8}) {
        const Foresight known = eight_groups(fall);
        CHECK(known.bound() == doctest::Approx(0.01).epsilon(1e-3));
        CHECK(known.bound_after(0, 1000) == doctest::Approx(known.bound()));
        // Equal groups: as the root of their number, however fast one of them falls.
        CHECK(known.bound_after(8, 1000) == doctest::Approx(0.01 / std::sqrt(2)).epsilon(1e-3));
        CHECK(known.bound_after(24, 1000) == doctest::Approx(0.01 / 2).epsilon(1e-3));
        // Beside eight that are far longer the others are nothing.
        CHECK(known.bound_after(8, 1e12) ==
              doctest::Approx(0.01 * std::pow(1e9, -fall)).epsilon(2e-3));
    }
    // Lines alone count where the error falls as their root, whatever the groups.
    CHECK(eight_groups(0.5).bound_after(4, 6000) == doctest::Approx(0.01 / 2).epsilon(1e-3));
    // Of few degrees of freedom, more groups bring the bound down further than the error.
    Foresight few = eight_groups(0.5);
    few.alike = 10;
    CHECK(few.bound_after(8, 1000) < few.bound() / std::sqrt(2));
    few.lines.resize(1);
    CHECK(std::isinf(few.bound()));
}

// Planted, seen to fail: always as many groups as a round may have.
TEST_CASE("a round is the least work that is expected to do") {
    Foresight known = eight_groups(0.6);
    known.alike = 30;
    CHECK(missing_round(known, known.bound(), 8, 16).groups == 0);
    for (double part : {0.98, 0.9, 0.8, 0.6, 0.3, 0.1}) {
        const double target = part * known.bound();
        const Round round = missing_round(known, target, 8, 1e9);
        CAPTURE(part);
        CHECK(round.length >= 1);
        CHECK(known.bound_after(round.groups, 1000 * round.length) <= target);
        if (round.length > 1) {
            CHECK(round.groups == 8);
            CHECK(known.bound_after(8, 1000 * round.length / 1.02) > target);
        } else if (round.groups > 1) {
            CHECK(known.bound_after(round.groups - 1, 1000) > target);
        }
    }
    // Not more than is allowed of what is there.
    const Round most = missing_round(known, 1e-9, 8, 16);
    CHECK(most.work() == doctest::Approx(16 * 8));
}

// Planted, each seen to fail: rounds sized by the seconds that they took; as many rays in every
// round, whatever its bundles; a preview that takes the estimate's memory, which crashed.
TEST_CASE("rounds and their previews: equal bits on any number of threads, seen or not") {
    const BareRoom room = unequal_room();
    SolveSettings settings;
    settings.lines_per_patch = 1;
    settings.target_error = 0.008;
    settings.first_shot_rays = 40000;
    settings.threads = 1;
    const Solution alone = solve(room.scene, room.patches, settings);
    CHECK(alone.groups > 8);
    CHECK(alone.relative_rms_bound <= 0.008);
    CHECK(alone.energy.residual[0] == 0);
    // As many rays a bundle in all rounds, but for what rounds up in each group.
    const double first = 2 * bundles_for_error;
    MESSAGE("bundles ", alone.bundles, ", rays ", alone.first_shot_rays);
    CHECK(static_cast<double>(alone.first_shot_rays) ==
          doctest::Approx(40000 * static_cast<double>(alone.bundles) / first).epsilon(0.01));
    for (unsigned threads : {2u, 3u, 7u}) {
        settings.threads = threads;
        std::uint32_t seen = 0;
        const Preview preview{0, [&](const Solution&) { ++seen; }};
        const Solution solution = solve(room.scene, room.patches, settings, {}, preview);
        CHECK(solution.hash == alone.hash);
        CHECK(solution.stderror == alone.stderror);
        CHECK(solution.bundles == alone.bundles);
        CHECK(seen == alone.groups - 1);
    }
}

// Planted, seen to fail: a preview that takes the estimate's memory, which crashed.
TEST_CASE("a preview is what the run would give that ends there") {
    const BareRoom room = unequal_room();
    SolveSettings settings;
    settings.bundles = 1600;
    settings.groups = 8;
    settings.lines_per_patch = 1;
    settings.first_shot = FirstShot::off;
    std::map<std::uint32_t, Solution> shown;
    const Solution whole =
        solve(room.scene, room.patches, settings, {},
              {0, [&](const Solution& so_far) { shown[so_far.groups] = so_far; }});
    CHECK(shown.size() == 7);
    CHECK(shown.at(1).stderror.empty());
    for (const auto& [groups, so_far] : shown) {
        CHECK(so_far.partial);
        CHECK(so_far.bundles == groups * 200);
        CHECK(so_far.energy.residual[0] == 0);
        CHECK(so_far.hash != whole.hash);
    }
    // Stopped within its fourth group.
    const Solution stopped = solve(room.scene, room.patches, settings,
                                   [](const Progress& progress) { return progress.done < 0.45; });
    REQUIRE(stopped.groups == 3);
    CHECK(shown.at(3).hash == stopped.hash);
    CHECK(shown.at(3).stderror == stopped.stderror);
    CHECK(shown.at(3).relative_rms_bound == stopped.relative_rms_bound);
}
