#include <doctest/doctest.h>

#include "parallux/solve.h"
#include "support/bare_room.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Sample quadratic_errors(const BareRoom& room, const SolveSettings& settings, int seeds) {
    Sample errors;
    for (const std::vector<float>& run : runs(room.scene, room.patches, settings, seeds, 1))
        errors.add(room.quadratic_error(run));
    return errors;
}

}  // namespace

TEST_CASE("at equal lines the closing gather divides the quadratic error by more than two") {
    // By three standard errors of both means. Fails when the gather divides by the expected number
    // of exits (planted: area / (2 δ²) a bundle for the count).
    const BareRoom room = unequal_room();
    SolveSettings settings;
    settings.first_shot = FirstShot::exact;
    settings.bundles = 1024;
    settings.groups = 1;
    const Sample gathered = quadratic_errors(room, settings, 24);
    settings.gather_share = 0;
    const Sample passed = quadratic_errors(room, settings, 24);
    MESSAGE("quadratic error falls by ", passed.mean() / gathered.mean());
    CHECK(passed.mean() - 3 * passed.standard_error() >
          2 * (gathered.mean() + 3 * gathered.standard_error()));
}

TEST_CASE("the closing gather has the exact solution for its mean") {
    // Every patch below the Šidák bound over 64 seeds. Fails when the first shot's light is
    // gathered too, and when the emission is not gathered though no first shot sent it (both
    // planted and seen).
    const BareRoom room = unequal_room();
    const double bound = sidak_bound(4 * room.patches.count(), 64);
    for (DirectionSet set : {DirectionSet::lattice, DirectionSet::random})
        for (FirstShot shot : {FirstShot::off, FirstShot::exact}) {
            SolveSettings settings;
            settings.first_shot = shot;
            settings.directions = set;
            settings.bundles = 512;
            settings.shots = shot == FirstShot::exact && set == DirectionSet::lattice ? 20 : 0;
            settings.lines_per_patch = 1;
            const std::vector<Sample> samples = over_seeds(room.scene, room.patches, settings, 64);
            CHECK(worst_z(samples, [&](std::size_t k) { return room.truth(k); }) < bound);
        }
}

TEST_CASE("the gather moves no energy") {
    // The balance is the pass's own, to the last quantum: a run of as many bundles without a
    // gather has it too. Fails when the emission is spread over the gathering bundles as well
    // (planted).
    const BareRoom room = unequal_room();
    SolveSettings settings;
    settings.bundles = 200;
    settings.gather_share = 0.5;
    const Solution whole = solve(room.scene, room.patches, settings);
    settings.bundles = 100;
    settings.gather_share = 0;
    settings.first_shot_rays = whole.first_shot_rays;
    const Solution pass = solve(room.scene, room.patches, settings);
    CHECK(whole.energy.absorbed == pass.energy.absorbed);
    CHECK(whole.energy.unshot == pass.energy.unshot);
    CHECK(whole.energy.residual[0] == 0);
    CHECK(whole.bundles == 200);
    CHECK(whole.counts.lines > pass.counts.lines);
    CHECK(whole.radiosity != pass.radiosity);
}
