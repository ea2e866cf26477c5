#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"
#include "solve/regions.h"
#include "solve/ways.h"
#include "transfer/banks.h"

namespace parallux {

/// What would still be received if the lines went on. Unshot energy may sit where it hardly leaves
/// (a lamp's inside, a cupboard, a gap above a lamp), so that it must not be spread over the scene:
/// some lines are kept, and the energy is followed along them over all its further bounces, as
/// M. Sbert's lines of 1993 solve a scene by counts, here with storage that does not grow with the
/// square of the patches. Where little is left, between groups of patches, in which it is even;
/// else from patch to patch. A closing gather smooths the noise of so few lines.
class Leftover {
public:
    /// `planned`: watts emitted in the whole run, a band. Keeps references to patches and regions.
    Leftover(const Patches& patches, const Regions& regions, std::vector<double> planned,
             unsigned threads);

    /// Of what was sent so far, the share that has neither been absorbed nor escaped, in the band
    /// where it is largest.
    static double held(const TransferState& state);
    /// Above that share, of all light or of what a group receives, it is followed from patch to
    /// patch.
    static constexpr double much = 1.0 / 8;

    /// What is received over the whole run by a patch with R quanta of area A: factor[band] · R,
    /// and where light can reach it factor[band] · to_come[region · bands + band] · A more.
    struct Spread {
        std::vector<double> factor, to_come;
        std::vector<bool> fine;  ///< from patch to patch, a band
    };
    /// `done`: the share of the planned emission that was to be sent.
    Spread spread(const TransferState& state, const Banks& banks, double done) const;
    std::uint32_t region(std::size_t patch) const { return regions_.of[patch]; }
    /// What stands in the dark is not lit by what it is joined with.
    bool reached(std::size_t patch, std::int64_t received, bool fine) const {
        return received > 0 || (fine && regions_.sizes[regions_.of[patch]] == 1);
    }

    /// All that it knows, to be written or read; see Ways.
    template <class Archive>
    void fields(Archive& a) {
        a(planned_);
        ways.fields(a);
    }
    bool sound() const { return planned_.size() == patches_.bands && ways.sound(); }

    Ways ways;

private:
    struct Sums;
    Sums sums(const TransferState& state, const Banks& banks, const std::vector<bool>& fine) const;
    Sums grouped(const Sums& regions) const;
    Spread spread_through(const TransferState& state, const Banks& banks, const Sums& groups,
                          Spread spread) const;
    std::vector<double> correction(const TransferState& state, double done) const;

    const Patches& patches_;
    const Regions& regions_;
    std::vector<double> planned_;
    unsigned threads_;
};

}  // namespace parallux
