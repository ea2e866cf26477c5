#include "solve/keeping.h"

#include <algorithm>

namespace parallux {

namespace {

std::size_t regions_of(std::size_t patches) {
    return std::min<std::size_t>(patches, 1 << 14);
}

// The system between groups is solved for every group of bundles and band.
std::size_t groups_of(std::size_t patches) {
    return std::clamp<std::size_t>(patches / 64, 64, 256);
}

// So many that `exits` lines leave each; never so few that it would matter to time.
double pairs_of(std::size_t regions, double exits) {
    constexpr double fewest = 1 << 15;
    return std::max(exits / 2 * static_cast<double>(regions), fewest);
}

constexpr double region_exits = 64, first_exits = 32;

}  // namespace

Keeping keeping_of(std::size_t patches, double pairs, std::uint64_t bundles) {
    Keeping keeping;
    keeping.regions = regions_of(patches);
    keeping.groups = groups_of(patches);
    auto stride = [&](std::uint64_t of, double wanted) {
        return static_cast<std::uint64_t>(std::max(1.0, pairs * static_cast<double>(of) / wanted));
    };
    keeping.first = std::min<std::uint64_t>(bundles, 64);
    keeping.first_stride = stride(keeping.first, pairs_of(keeping.regions, first_exits));
    keeping.stride = stride(bundles, pairs_of(keeping.regions, region_exits));
    return keeping;
}

std::uint64_t keeping_bytes(std::size_t patches, std::uint32_t bands) {
    // Strides are whole numbers: up to twice as many pairs may be kept. Both ends of each in the
    // table; some thirteen values a region and band; the system between groups.
    const std::uint64_t regions = regions_of(patches), groups = groups_of(patches);
    const auto pairs = static_cast<std::uint64_t>(1.5 * pairs_of(regions, region_exits));
    return patches * 4 + pairs * 16 + regions * (bands * 104 + 16) +
           groups * groups * (bands * 8 + 12);
}

}  // namespace parallux
