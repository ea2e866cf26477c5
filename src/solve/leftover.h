#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "parallux/patches.h"
#include "transfer/banks.h"

namespace parallux {

/// What would still be received if the lines went on. Unshot energy may sit where it never leaves
/// (a lamp's inside, a cupboard), so that it must not be spread over the whole scene: the patches
/// of one object and side form a group, and the fall of what each group received in the two halves
/// of the closing bundles, a geometric series, tells what is still to come to it. One common factor
/// then closes the balance.
class Leftover {
public:
    /// `planned`: watts emitted in the whole run, a band. Keeps references to scene and patches.
    Leftover(const Scene& scene, const Patches& patches, std::vector<double> planned,
             unsigned threads);

    /// Notes what every group has received so far: when the closing bundles begin, halfway, and at
    /// their end.
    void note(const Banks& banks);

    /// By what each patch and band's received energy is to be multiplied. `done`: the share of the
    /// planned emission that was to be sent. Without three notes (a run stopped early or too short)
    /// one factor for all: planned / (absorbed + escaped).
    std::vector<double> factors(const TransferState& state, const Banks& banks, double done) const;

    /// Calls visit(first, last, group) for runs of the patches begin … end - 1 of one group each;
    /// the group is an index into the factors: factors[group * bands + band].
    void for_groups(
        std::size_t begin, std::size_t end,
        const std::function<void(std::size_t, std::size_t, std::uint32_t)>& visit) const;

private:
    // Integers add up alike on any number of threads.
    using Sums = std::vector<std::int64_t>;
    // Sums over each group and band of value(patch, band).
    Sums sums(const std::function<std::int64_t(std::size_t, std::uint32_t)>& value) const;

    const Scene& scene_;
    const Patches& patches_;
    std::vector<std::uint32_t> surfaces_;  // those that patches were first made for, in their order
    std::uint32_t count_ = 0;              // of groups: 2 · object + side
    std::vector<double> planned_;
    unsigned threads_;
    std::vector<Sums> notes_;
};

}  // namespace parallux
