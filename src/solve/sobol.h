#pragma once

#include <array>
#include <cstdint>

#include "random.h"

namespace parallux {

/// Points of a five-dimensional Sobol sequence (direction numbers of S. Joe and F. Y. Kuo, 2008),
/// each dimension scrambled in Owen's manner by a hash (B. Burley, Practical hash-based Owen
/// scrambling, JCGT 9(4), 2020). Point k is a pure function of (seed, k), k < 2³².
class Sobol {
public:
    static constexpr unsigned dimensions = 5;

    explicit Sobol(std::uint64_t seed);

    /// Coordinates in [0, 1).
    std::array<double, dimensions> point(std::uint32_t index) const;

private:
    // What each value of each byte of the index adds.
    std::array<std::array<std::array<std::uint32_t, dimensions>, 256>, 4> bytes_;
    std::array<std::uint32_t, dimensions> scramble_;
};

}  // namespace parallux
