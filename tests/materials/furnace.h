#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "parallux/solve.h"
#include "support/seeds.h"

namespace parallux::test {

/// Radiosity of all that is diffuse in a furnace: what emits (1 - ρ) of it leaves as much light as
/// came.
inline constexpr double everywhere = 2;

/// Solves a closed room that is a furnace, without first shots and with rays: the balance closes,
/// next to nothing escapes, every patch has its radiosity by Šidák's bound over 16 seeds, and their
/// mean has it to 0.002. `covered`: some patches lie under others, in the dark.
inline void check_furnace(const Scene& scene, double may_escape, bool covered = false) {
    const Patches patches = make_patches(scene);
    for (FirstShot shot : {FirstShot::off, FirstShot::rays}) {
        CAPTURE(int(shot));
        SolveSettings settings;
        settings.bundles = 256;
        settings.first_shot = shot;
        const Solution one = solve(scene, patches, settings);
        CHECK(one.energy.residual[0] == 0);
        CAPTURE(double(one.energy.escaped[0]) / double(one.energy.emitted[0]));
        CHECK(double(one.energy.escaped[0]) <= may_escape * double(one.energy.emitted[0]));
        const std::vector<Sample> samples = over_seeds(scene, patches, settings, 16);
        double worst = 0, sum = 0;
        std::size_t count = 0;
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const double diffuse = 1 - patches.specular_share(k);
            const double expected =
                patches.emission[k] + diffuse * everywhere * patches.reflectance[k];
            if (diffuse == 0) {
                CHECK(samples[k].mean() == doctest::Approx(expected));
                continue;
            }
            if (covered && samples[k].standard_error() == 0)
                continue;
            worst = std::max(worst, std::fabs(samples[k].z(expected)));
            sum += samples[k].mean() / expected;
            ++count;
        }
        REQUIRE(count >= 24);
        CHECK(worst < sidak_bound(count, 16));
        CHECK(sum / double(count) == doctest::Approx(1).epsilon(0.002));
    }
}

}  // namespace parallux::test
