#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallux/aligned.h"
#include "parallux/lines.h"
#include "parallux/patches.h"

// Stage 5: energy along the lists. All energy is counted in 64-bit integer quanta, so that sums
// are the same in any order and the balance closes exactly.

namespace parallux {

enum class Direction { bidirectional, oriented };

/// Counters of the lines a worker followed; they add up.
struct LineCounts {
    std::uint64_t lines = 0;      ///< cast
    std::uint64_t nonempty = 0;   ///< that met something
    std::uint64_t hits = 0;       ///< crossings of surfaces
    std::uint64_t transfers = 0;  ///< pairs of patches that exchanged
    std::uint64_t odd = 0;        ///< lists of odd length
    std::uint64_t met_backs = 0;  ///< exits that ended at the back of a one-sided surface

    LineCounts& operator+=(const LineCounts& other);
};

/// Places that a patch takes where a count of exits lies behind its bands: 2, 4, 8 or 12.
constexpr std::uint32_t lanes(std::uint32_t bands) {
    return bands < 2 ? 2 : bands < 4 ? 4 : bands < 8 ? 8 : 12;
}

/// Where the energy is. Arrays hold bands together: unshot[patch * bands + band].
struct TransferState {
    std::uint32_t bands = 0;
    double watts_per_quantum = 0;        ///< a power of two
    std::vector<std::int64_t> unshot;    ///< reflected power not yet sent on
    std::vector<std::int64_t> received;  ///< power that arrived in the global pass
    std::vector<std::int64_t> emission;  ///< sent with every exit, all run long
    /// Carried by an exit of this batch: emission + share. quanta[patch * lanes + band]; behind the
    /// bands stands 1, the exit itself, so that one addition both sends and counts.
    QuantaArray quanta;
    std::vector<std::uint64_t> exits;    ///< lines that left the patch so far
    std::vector<std::int64_t> sky;       ///< band totals of what the sky sent in
    std::vector<std::int64_t> emitted;   ///< band totals of emission quanta sent
    std::vector<std::int64_t> absorbed;  ///< band totals
    std::vector<std::int64_t> escaped;
};

/// What one or more workers add to the state within a batch: received[patch * lanes + band], and
/// behind the bands the exits.
struct Deltas {
    QuantaArray received;
};

/// A worker's own totals within a batch; no two share a cache line.
struct alignas(64) WorkerTotals {
    LineCounts counts;
    std::vector<std::int64_t> escaped = std::vector<std::int64_t>(max_bands, 0);
    /// What came in from outside the exchange: from the sky, or from a light's first shot.
    std::vector<std::int64_t> sky = std::vector<std::int64_t>(max_bands, 0);
};

/// What the lines of one direction bring from outside the scene, quanta a line and band.
struct SkyQuanta {
    std::int64_t along[max_bands] = {};    ///< entering against the first hit, travelling along
    std::int64_t against[max_bands] = {};  ///< entering at the last hit, travelling back
};

/// A state without any energy in it. O(patches).
TransferState dark_state(const Patches& patches, double watts_per_quantum);

/// Sets what every exit carries until the next merge: its emission quantum and the linear share
/// min(1, cell / area) / batch of its unshot energy. `cell` is the area across the direction that
/// one line stands for (δ² of a bundle). O(patches), in parallel.
void share_unshot(TransferState& state, const Patches& patches, double cell, std::uint32_t batch,
                  unsigned threads);

/// Follows the lists: neighbours on a line that face each other send each other their quanta
/// (oriented: only along the direction). What meets the back of a one-sided surface or leaves the
/// scene is counted as escaped; it goes no further. `sky` is empty, one for all lines (a bundle) or
/// one a line. `shared`: another worker may add to the same
/// deltas at this time, so that additions are atomic.
void exchange(const IntersectionLists& lists, const TransferState& state, Direction direction,
              std::span<const SkyQuanta> sky, Deltas& deltas, bool shared, WorkerTotals& totals);

/// The same for the pairs of a bundle's lines, all under one sky.
void exchange_pairs(const TilePairs& pairs, const TransferState& state, Direction direction,
                    const SkyQuanta* sky, Deltas& deltas, bool shared, WorkerTotals& totals);

/// Follows the lists one line after the other, as the paper prints it: of every pair the first
/// sends the second all that is unshot, and its emission quantum (bidirectional: both do, at once);
/// the reflected share of what arrives is unshot from then on. The state is exact after each line.
/// Ends and backs count as in exchange(). Serial by nature.
void exchange_in_order(const IntersectionLists& lists, TransferState& state, const Patches& patches,
                       Direction direction, std::span<const SkyQuanta> sky, LineCounts& counts);

/// Adds all deltas and totals to the state and clears them: what was sent leaves unshot, what came
/// is absorbed or becomes unshot, exactly. O(patches), in parallel.
void merge(TransferState& state, const Patches& patches, std::vector<Deltas>& deltas,
           std::vector<WorkerTotals>& totals, unsigned threads);

}  // namespace parallux
