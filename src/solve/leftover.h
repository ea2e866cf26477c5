#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"
#include "solve/regions.h"
#include "transfer/banks.h"

namespace parallux {

/// What would still be received if the lines went on. Unshot energy may sit where it never leaves
/// (a lamp's inside, a cupboard), so that it must not be spread over the whole scene: lines are
/// counted between some hundred regions, and the energy is followed over all its further bounces
/// from region to region, in which it is even (aggregation, as of Markov chains: H. A. Simon and
/// A. Ando, Aggregation of Variables in Dynamic Systems, Econometrica 29, 1961). Light that has
/// bounced long is even where much is left over, and a closing gather smooths what is not.
class Leftover {
public:
    /// `planned`: watts emitted in the whole run, a band. Keeps references to patches and regions.
    Leftover(const Patches& patches, const Regions& regions, std::vector<double> planned,
             unsigned threads);

    /// Bundles enough to know the ways between regions by: what they lead is a small part.
    static constexpr std::uint64_t enough = 32;

    /// Counts the ways of some lines; each worker into a table of its own.
    void count(const TilePairs& pairs, unsigned worker);

    /// What is received over the whole run by a patch with R quanta of area A:
    /// factor[band] · (R + R > 0 ? even[region · bands + band] · A : 0).
    struct Spread {
        std::vector<double> factor, even;
    };
    /// `done`: the share of the planned emission that was to be sent.
    Spread spread(const TransferState& state, const Banks& banks, double done) const;
    std::uint32_t region(std::size_t patch) const { return regions_.of[patch]; }

private:
    struct Sums;
    Sums sums(const TransferState& state, const Banks& banks) const;
    std::vector<double> follow(const std::vector<double>& ways, const Sums& sums,
                               std::uint32_t band) const;
    std::vector<double> ways() const;

    const Patches& patches_;
    const Regions& regions_;
    std::vector<double> planned_;
    unsigned threads_;
    std::vector<std::vector<std::uint64_t>> counts_;  // a worker: from · (regions + 1) + to; the
                                                      // last column is out of the scene
};

}  // namespace parallux
