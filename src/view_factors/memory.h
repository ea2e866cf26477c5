#pragma once

#include <cstdint>

#include "parallux/factors.h"
#include "view_factors/pair_counts.h"

namespace parallux {

/// What counting and scaling will take, and whether they may.
class FactorMemory {
public:
    FactorMemory(const Scene& scene, const Patches& patches, std::size_t nodes,
                 std::uint32_t outsides, unsigned threads, std::uint64_t max_memory);

    /// Before anything is counted: without the pairs, of which nothing is known.
    void check_base() const;
    /// After `done` of `all` bundles, the pairs that there will be: those seen, and of the unseen
    /// those that so many more lines find (A. Chao's estimate of their number from pairs met once
    /// and twice; R. K. Colwell et al., Models and estimators linking individual-based and
    /// sample-based rarefaction, extrapolation and comparison of assemblages, 2012, eq. 9). Returns
    /// the bytes of the whole process.
    std::uint64_t check_pairs(const PairCounts::Pairs& pairs, double done, double all) const;
    /// While counting: what has been taken.
    void check_tables(const PairCounts& counts) const;

private:
    void refuse_above(std::uint64_t bytes, const char* when) const;
    std::uint64_t base_, limit_;
};

}  // namespace parallux
