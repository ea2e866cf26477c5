#pragma once

#include <cstdint>
#include <functional>

#include "solve/emitters.h"
#include "solve/run.h"

namespace parallux {

/// The patch that a ray's hit lands on; none: an inert back.
std::uint32_t patch_of(const Scene& scene, const Patches& patches, const SurfaceHit& hit);

/// Patches that take part in shots of rays: what they receive and reflect is sent on at once, by a
/// ray from a uniform point of theirs, so that it does not wait for lines that hardly ever come.
class Relays {
public:
    /// The patches smaller than a sixteenth of the mean.
    Relays(const Scene& scene, const Patches& patches, unsigned threads);

    bool empty() const { return cells_.count() == 0; }
    /// The cells of a patch by the place that this finds; none: it keeps what it receives.
    std::uint32_t find(std::uint32_t patch) const;
    const PatchCells& cells() const { return cells_; }
    /// Quanta that a worker's rays took from the patch at a place, one a band.
    std::int64_t* sent(unsigned worker, std::uint32_t place);
    /// Adds what all workers' rays took to shot[patch * bands + band].
    void add_to(std::vector<std::int64_t>& shot) const;

private:
    const Patches& patches_;
    double small_;
    std::vector<std::uint32_t> relays_;  // ascending
    PatchCells cells_;
    std::vector<std::vector<std::int64_t>> sent_;
};

/// Sends the power of the emitters along `rays` local rays into the workers' banks: a scrambled
/// Sobol point, which `key` chooses, picks the emitter by its power, the point on it and a
/// direction by the cosine law, so that every ray carries the same power (summed over bands). The
/// powers of a single patch are carried to the last quantum; of several, as the rays fall to them.
/// Rays are counted where they go: received, or escaped; what came in is in the totals' `sky`. What
/// relays receive they send on, to the last whole quantum; null: there are none.
/// `go_on(share done)` is asked after each slab of rays; false stops. Returns the share done.
double shoot_rays(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key,
                  Relays* relays, const std::function<bool(double)>& go_on);

}  // namespace parallux
