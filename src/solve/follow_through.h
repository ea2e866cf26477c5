#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "parallux/spectrum.h"

namespace parallux {

/// The share, a band, of what one region receives that leaves from another one: what lies in both
/// lets light through.
struct Crossing {
    std::uint32_t from, to;
    std::array<double, max_bands> share{};
};

/// What becomes of light between regions, or groups of them. Arrays region · bands + band.
struct Through {
    std::uint32_t bands;
    std::vector<double> reflectance, received;  ///< received: before
    std::vector<std::uint32_t> group;           ///< of each region
    std::vector<Crossing> crossings;
    std::vector<std::uint32_t> exits;  ///< lines that leave each region
    /// Σ over the lines that join a region with others of what those carry.
    std::function<std::vector<double>(const std::vector<double>&)> neighbours;
};

/// x = P (u + S x): as GroupSystem has it, where S takes light through surfaces and the system is
/// not symmetric. By Bi-CGSTAB, to some thousandths of all that each group receives (Settled).
std::vector<double> follow_through(const Through& through, const std::vector<double>& unshot);

}  // namespace parallux
