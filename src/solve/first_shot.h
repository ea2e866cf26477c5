#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lines/ray_scene.h"
#include "parallux/patches.h"
#include "transfer/delta_banks.h"

namespace parallux {

/// Light that came straight from the sources, in quanta; bands of a patch together.
struct DirectLight {
    std::vector<std::int64_t> received;   ///< patch · bands + band
    std::vector<std::int64_t> reflected;  ///< what of it becomes the emission of the global pass
    std::vector<std::int64_t> emitted, escaped;  ///< band totals
    double done = 1;                             ///< share of the wanted rays that were cast
};

struct FirstShotSettings {
    std::uint64_t rays = 0;  ///< from all area lights together
    std::uint64_t seed = 1;
    unsigned threads = 0;
    double watts_per_quantum = 1;
};

/// Shoots `rays` local rays from the emitting patches: a scrambled Sobol point chooses the emitter
/// by its power, the point on it and a direction by the cosine law, so that every ray carries the
/// same power (summed over bands). Then adds the lights without area: irradiance at stratified
/// points of each patch, with a shadow ray each. `go_on(share done)` false stops early.
DirectLight first_shot(const Scene& scene, const Patches& patches, const RayScene& rays,
                       const FirstShotSettings& settings, DeltaBanks& banks,
                       const std::function<bool(double)>& go_on);

}  // namespace parallux
