#pragma once

#include <cstdint>
#include <vector>

#include "parallux/transfer.h"
#include "solve/run.h"

namespace parallux {

/// Where the power of the sources is once the local shots are over. emitted = absorbed + escaped +
/// unshot, exactly. Until settle() the banks hold what patches have received.
struct DirectLight {
    bool own = false;      ///< the emission of the patches themselves is left for the pass
    bool arrived = false;  ///< there are local shots, and the banks hold what they brought
    /// Quanta that single shots took from patches, patch · bands + band; empty: none.
    std::vector<std::int64_t> shot;
    std::vector<std::int64_t> emitted, absorbed, escaped, unshot;  ///< band totals
    std::vector<float> irradiance;  ///< W/m², patch · bands + band; empty: no light arrived
    /// Left for the pass, W/m²; empty: own emission, if so, and what leaves again of irradiance.
    std::vector<float> exitance;
    std::uint64_t rays = 0;   ///< cast
    std::uint64_t shots = 0;  ///< from single patches
    bool settled = false;     ///< settle() has been called
    double done = 1;          ///< share of the sources' rays that was cast

    std::int64_t sent_on(std::size_t k) const { return shot.empty() ? 0 : shot[k]; }
};

/// What a patch emits by itself, in quanta.
std::int64_t emitted_quanta(const Patches& patches, double watts_per_quantum, std::size_t k);

/// What is unshot of one patch and band before settle(), k = patch * bands + band.
std::int64_t unshot_quanta(const Run& run, const DirectLight& direct, std::size_t k);

/// Ends the local shots: what has arrived is absorbed in part, and the rest is unshot, exactly.
/// Clears the banks. O(patches), in parallel; nothing the second time.
void settle(const Run& run, DirectLight& direct);

/// What the patches send of their own in the pass; `direct` must be settled and outlive it.
Emission emission_of(const Patches& patches, const DirectLight& direct);

}  // namespace parallux
