#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "parallux/solve.h"
#include "support/hand_made.h"

using namespace parallux;
using namespace parallux::test;

namespace {

constexpr std::uint32_t bands = 8;

Scene coloured_room() {
    Material wall = grey(0.5), light = grey(0.2, 1);
    for (std::uint32_t band = 0; band < bands; ++band) {
        wall.reflectance[band] = 0.1f * static_cast<float>(band + 1);
        light.emission[band] = static_cast<float>(band == 3 ? 0 : 1 + band);
    }
    Scene scene = l_room(wall, light, 3);
    scene.surfaces.pop_back();  // so that a sky shines in
    scene.bands = bands;
    scene.sky.kind = Sky::Kind::uniform;
    for (std::uint32_t band = 0; band < bands; ++band)
        scene.sky.zenith[band] = 0.1f * static_cast<float>(bands - band);
    return scene;
}

Scene only(Scene scene, std::uint32_t band) {
    scene.bands = 1;
    for (Material& material : scene.materials) {
        material.reflectance = Spectrum::constant(material.reflectance[band]);
        material.emission = Spectrum::constant(material.emission[band]);
    }
    scene.sky.zenith = Spectrum::constant(scene.sky.zenith[band]);
    return scene;
}

}  // namespace

TEST_CASE("eight bands in one pass are eight runs of one band, but for their quanta") {
    // The lines are the same, and exact first shots too; what differs is how large a quantum is,
    // and so what is rounded. Of first shots by rays this would not hold: rays fall by the power of
    // all bands; nor of long runs, whose closing bundles and batches go by the slowest band.
    // Fails (planted, seen) when the gather sends the reflectance of band 0 in all bands.
    const Scene scene = coloured_room();
    const Patches patches = make_patches(scene);
    for (Method method : {Method::bundles, Method::lines})
        for (std::uint32_t groups : {1u, 4u}) {
            if (method == Method::lines && groups > 1)
                continue;
            SolveSettings settings;
            settings.method = method;
            settings.first_shot = FirstShot::exact;
            settings.bundles = 24 * groups;  // few, so that as many close the pass for all bands
            settings.groups = groups;
            settings.batch = 1;           // else shorter where one band lags
            settings.gather_share = 0.6;  // else by the highest reflectance of all bands
            const Solution all = solve(scene, patches, settings);
            for (std::uint32_t band = 0; band < bands; ++band) {
                CAPTURE(band);
                CAPTURE(groups);
                const Scene single = only(scene, band);
                const Solution one = solve(single, make_patches(single), settings);
                CHECK(one.counts.lines == all.counts.lines);
                CHECK(one.crossings == all.crossings);
                double worst = 0, mean = 0;
                for (std::size_t patch = 0; patch < patches.count(); ++patch) {
                    const double a = all.irradiance[patch * bands + band],
                                 b = one.irradiance[patch];
                    worst = std::max(worst, std::fabs(a - b));
                    mean += b / double(patches.count());
                }
                CHECK(worst < 2e-6 * mean);
                CHECK(all.energy.residual[band] == 0);
            }
        }
}
