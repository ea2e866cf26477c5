#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"
#include "parallux/transfer.h"

namespace parallux {

/// What would still be received if the lines went on. Unshot energy may sit where it never leaves
/// (a lamp's inside, a cupboard), so that it must not be spread over the whole scene: the patches
/// of one object and side form a group, and the fall of what each group received in the two halves
/// of the closing bundles, a geometric series, tells what is still to come to it. One common factor
/// then closes the balance.
class Leftover {
public:
    /// `planned`: the emission quanta of the whole run, patch by patch.
    Leftover(const Scene& scene, const Patches& patches, const std::vector<std::int64_t>& planned);

    /// Notes what every group has received so far: when the closing bundles begin, halfway, and at
    /// their end.
    void note(const TransferState& state);

    /// By what each patch and band's received energy is to be multiplied. `done`: the share of the
    /// planned emission that was to be sent. Without three notes (a run stopped early or too short)
    /// one factor for all: planned / (absorbed + escaped).
    std::vector<double> factors(const TransferState& state, const Patches& patches,
                                double done) const;

    /// Index into the factors of a patch: factors[group(patch) * bands + band].
    std::uint32_t group(std::size_t patch) const { return groups_[patch]; }

private:
    std::vector<std::uint32_t> groups_;  // one a patch: 2 · object + side
    std::uint32_t count_ = 0;
    std::vector<std::int64_t> planned_;  // band totals
    std::vector<std::vector<double>> notes_;
};

}  // namespace parallux
