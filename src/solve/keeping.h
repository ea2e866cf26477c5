#pragma once

#include <cstddef>
#include <cstdint>

namespace parallux {

/// How many lines a pass keeps to follow its leftover by: of the first bundles so many that 16
/// leave each region; where much is left over 64, of all bundles: what leads out of a narrow place
/// is seen from few directions, and light would stay too long in the mean of what few of them show.
struct Keeping {
    std::size_t regions = 1;         ///< about so many,
    std::size_t groups = 1;          ///< in about so many groups
    std::uint64_t first = 0;         ///< of so many bundles
    std::uint64_t first_stride = 1;  ///< one of so many pairs is kept;
    std::uint64_t stride = 1;        ///< of all bundles one of so many where much is left over
};

/// `pairs`: that a bundle leads, in the mean.
Keeping keeping_of(std::size_t patches, double pairs, std::uint64_t bundles);

/// Bytes of all that, from the pass on and while the leftover is followed.
std::uint64_t keeping_bytes(std::size_t patches, std::uint32_t bands);

}  // namespace parallux
