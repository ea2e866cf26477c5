#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallux/aligned.h"
#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/scatter.h"

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

/// What has arrived and left since a bank was last cleared: received[patch * lanes + band], and
/// behind the bands the exits, so that one addition both sends and counts.
struct Bank {
    AlignedArray<std::int64_t> received;
};

/// What patches send of their own: quanta * (own + scattered(direct)) with every exit, all run
/// long. Arrays hold bands together, W/m²; an empty one is dark. They must outlive their use.
struct Emission {
    std::span<const float> own;
    std::span<const float> direct;
    double quanta = 0;  ///< of an exit, per W/m²

    /// Quanta an exit carries, k = patch * bands + band.
    double of_exit(const Patches& patches, std::size_t k) const {
        double exitance = own.empty() ? 0 : own[k];
        if (!direct.empty())
            exitance += scattered(patches, k, [&](std::size_t at) { return direct[at]; });
        return quanta * exitance;
    }
};

/// Where the energy is, beside what the banks hold. A patch has scattered_quanta(received) -
/// sent quanta unshot.
struct TransferState {
    std::uint32_t bands = 0;
    double watts_per_quantum = 0;  ///< a power of two
    Emission emission;
    std::uint32_t dither = 0;        ///< of what exits carry, in 2⁻³²; any number to begin with
    std::vector<std::int64_t> sent;  ///< reflected power sent on; sent[patch * bands + band]
    /// Carried by an exit of this batch: emission + share. carried[patch * lanes + band]; behind
    /// the bands the exits that the last merge has seen, modulo 2³². Empty before the first merge.
    AlignedArray<std::int32_t> carried;
    std::vector<std::int64_t> sky;       ///< band totals of what the sky sent in
    std::vector<std::int64_t> emitted;   ///< band totals of emission quanta sent
    std::vector<std::int64_t> lost;      ///< band totals of what mirrors and glass absorbed
    std::vector<std::int64_t> absorbed;  ///< band totals, with those
    std::vector<std::int64_t> escaped;
};

/// A worker's own totals within a batch; no two share a cache line.
struct alignas(64) WorkerTotals {
    LineCounts counts;
    std::vector<std::int64_t> escaped = std::vector<std::int64_t>(max_bands, 0);
    /// What came in from outside the exchange: from the sky, or from a light's first shot.
    std::vector<std::int64_t> sky = std::vector<std::int64_t>(max_bands, 0);
    /// What mirrors and glass have absorbed.
    std::vector<std::int64_t> lost = std::vector<std::int64_t>(max_bands, 0);
};

/// What the lines of one direction bring from outside the scene, quanta a line and band.
struct SkyQuanta {
    std::int64_t along[max_bands] = {};    ///< entering against the first hit, travelling along
    std::int64_t against[max_bands] = {};  ///< entering at the last hit, travelling back
};

/// What exits are to carry from a merge on.
struct Share {
    double cell = 0;  ///< area across the direction that one line stands for, δ² of a bundle
    std::uint32_t batch = 1;  ///< bundles that share what is unshot
    double emission = 0;      ///< Emission::quanta from then on
};

/// The most that an exit carries of what is unshot; what would be more stays unshot.
inline constexpr std::int32_t most_carried = 1 << 30;

/// A state without any energy in it. O(patches).
TransferState dark_state(const Patches& patches, double watts_per_quantum);

/// Follows the lists: neighbours on a line that face each other send each other what they carry
/// (oriented: only along the direction). What meets the back of a one-sided surface or leaves the
/// scene is counted as escaped; it goes no further. `sky` is empty, one for all lines (a bundle) or
/// one a line. `shared`: another worker may add to the same bank at this time, so that additions
/// are atomic.
void exchange(const IntersectionLists& lists, const TransferState& state, Direction direction,
              std::span<const SkyQuanta> sky, Bank& bank, bool shared, WorkerTotals& totals);

/// The same for the pairs of a bundle's lines, all under one sky, into a bank of the worker's own.
void exchange_pairs(const TilePairs& pairs, const TransferState& state, Direction direction,
                    const SkyQuanta* sky, Bank& bank, WorkerTotals& totals);

/// Follows the lists one line after the other, as the paper prints it: of every pair the first
/// sends the second all that is unshot, and its emission quantum (bidirectional: both do, at once);
/// the reflected share of what arrives is unshot from then on. State and bank are exact after each
/// line. Ends and backs count as in exchange(). Serial by nature.
void exchange_in_order(const IntersectionLists& lists, TransferState& state, Bank& bank,
                       const Patches& patches, Direction direction, std::span<const SkyQuanta> sky,
                       LineCounts& counts);

/// Takes up what the banks have got since the last merge: what was sent leaves unshot, what came is
/// absorbed or becomes unshot, exactly. Then sets what every exit carries until the next merge: its
/// emission and the linear share min(1, cell / area) / batch of its unshot energy, dithered from
/// merge to merge so that what is less than a quantum is carried in the mean. The banks keep what
/// they have; workers' totals are cleared. Between two merges a patch may be left by fewer than 2³¹
/// lines. O(patches), in parallel.
void merge(TransferState& state, const Patches& patches, const std::vector<Bank>& banks,
           std::vector<WorkerTotals>& totals, const Share& next, unsigned threads);

}  // namespace parallux
