#pragma once

#include <cstdint>

#include "parallux/factors.h"
#include "view_factors/pair_counts.h"

namespace parallux {

/// What counting and scaling will take, and whether they may.
class FactorMemory {
public:
    FactorMemory(const Scene& scene, const Patches& patches, std::size_t nodes, const Factors& plan,
                 const FactorSettings& settings);

    /// Before anything is counted: without the pairs, of which nothing is known.
    void check_base() const;
    /// What `pairs` that are expected at the end will take; returns the bytes of the whole process.
    std::uint64_t check_pairs(double pairs) const;
    /// While counting: what has been taken.
    void check_counts(const PairCounts& counts) const;

private:
    void refuse_above(std::uint64_t bytes, const char* when) const;
    std::uint64_t base_, limit_, bytes_a_pair_;
};

/// Pairs that all bundles will find, from those that were found when half of `done` were done and
/// now. What a doubling adds in proportion shrinks from doubling to doubling: to 0.85, as it does
/// in a city of 22 881 facets from 64 to 1024 bundles.
double pairs_to_come(double at_half, double now, double done, double all);

}  // namespace parallux
