#pragma once

#include <cstdint>
#include <functional>

#include "solve/emitters.h"
#include "solve/run.h"

namespace parallux {

/// The patch that a ray's hit lands on; none: an inert back.
std::uint32_t patch_of(const Scene& scene, const Patches& patches, const SurfaceHit& hit);

/// Sends the power of the emitters along `rays` local rays into the workers' banks. They leave by
/// the emitters' power, in even steps from a random place, each slab of 2^18 rays from all of it; a
/// scrambled Sobol point, which `key` chooses, picks the point of the emitter and a direction by
/// the cosine law, so that every ray carries the same power (summed over bands). The powers of a
/// single patch are carried to the last quantum; of several, as the rays fall to them. Rays are
/// counted where they go: received, or escaped; what came in is in the totals' `sky`. Begins behind
/// the first `done` rays, which counts on. `go_on(share done)` is asked after each slab of rays;
/// false stops. Returns the share done.
double shoot_rays(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key,
                  std::uint64_t& done, const std::function<bool(double)>& go_on);

}  // namespace parallux
