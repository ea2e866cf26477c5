#pragma once

#include <cstddef>
#include <cstdint>

#include "parallux/transfer.h"

namespace parallux {

/// What one merge reads and writes, as merge() says. Arrays as in TransferState and Patches.
struct MergeJob {
    std::uint32_t bands;
    const double* area;
    const float *reflectance, *own, *direct;  ///< own, direct: null where dark
    const float* transmittance;               ///< null: nothing lets light through
    const std::uint32_t* other;               ///< beside transmittance
    const std::int64_t* const* banks;
    std::size_t bank_count;
    std::int64_t* sent;
    std::int32_t* carried;
    double cell, batch;
    double emission_before, emission_after;     ///< quanta an exit, per W/m²
    std::uint32_t dither_before, dither_after;  ///< where the merges' own step stands
};

/// Band totals of a worker's patches: absorbed since the banks were cleared, emitted since the last
/// merge.
struct alignas(64) MergeTotals {
    std::int64_t absorbed[max_bands] = {};
    std::int64_t emitted[max_bands] = {};
};

/// What is less than a quantum is rounded down after a number of [0, 1) was added: fraction of
/// patch √2 + band √3 + merge (√5 + 1) / 2, in 2⁻³². The golden section makes the mean over merges
/// exact as fast as any sequence can.
inline constexpr std::uint32_t dither_patch = 0x6a09e667u, dither_band = 0xbb67ae85u,
                               dither_merge = 0x9e3779b9u;

}  // namespace parallux
