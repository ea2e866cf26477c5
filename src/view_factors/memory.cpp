#include "view_factors/memory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <unistd.h>

#include "lines/facets.h"
#include "lines/periodic.h"
#include "parallux/error.h"
#include "view_factors/expected_lines.h"
#include "view_factors/pair_sweep.h"

namespace parallux {

namespace {

// A pair stands in lists, in the rows of a group and of all, at last on both sides of the matrix;
// as measured, with what the allocator leaves between. More where rows of groups are joined, and
// where entries are left out of a copy.
constexpr std::uint64_t bytes_a_pair = 64, more_of_groups = 16, more_of_threshold = 56;

std::uint64_t machine_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

FactorMemory::FactorMemory(const Scene& scene, const Patches& patches, std::size_t nodes,
                           const Factors& plan, const FactorSettings& settings)
    : limit_(settings.max_memory ? settings.max_memory : machine_memory()),
      bytes_a_pair_(bytes_a_pair + (plan.groups > 1 ? more_of_groups : 0) +
                    (settings.threshold > 0 ? more_of_threshold : 0)) {
    const unsigned threads = plan.threads;
    const std::uint32_t outsides = plan.outsides();
    // The program, what lists hold, surfaces as read and as projected.
    base_ = (std::uint64_t(60) << 20) + (std::uint64_t(88) << 20) +
            threads * (std::uint64_t(4) << 20) +
            scene.surfaces.size() * (sizeof(Surface) + sizeof(SurfaceGrid) + 64) +
            scene.positions.size() * (sizeof(glm::dvec3) + 12);
    base_ += facets_bytes(scene, patches, 0, threads);
    base_ += ExpectedLines::bytes(patches.count()) + threads * nodes * 6 * 8;
    base_ += PairSweep::bundles_at_once(scene, threads) * copies_bytes(scene);
    base_ += patches.count() * (8 + patches.bands * 8 + 4 + sizeof(PatchPlace));
    base_ += nodes * (sizeof(FactorNode) + 64 * 8) + nodes * outsides * (4 * 8 + 2 * 8);
}

void FactorMemory::refuse_above(std::uint64_t bytes, const char* when) const {
    if (bytes <= limit_)
        return;
    throw Error(Fault::memory,
                std::string("these factors need ") + when + std::to_string((bytes >> 20) + 1) +
                    " MiB, more than the " + std::to_string(limit_ >> 20) +
                    " MiB allowed; choose fewer bundles, larger patches, --between surfaces or "
                    "objects, or raise --max-memory");
}

void FactorMemory::check_base() const {
    refuse_above(base_, "at least ");
}

std::uint64_t FactorMemory::check_pairs(double pairs) const {
    const std::uint64_t bytes =
        base_ + static_cast<std::uint64_t>(pairs * static_cast<double>(bytes_a_pair_));
    refuse_above(bytes, "about ");
    return bytes;
}

double pairs_to_come(double at_half, double now, double done, double all) {
    constexpr double shrinks = 0.85;
    if (!(at_half > 0))
        return now;
    const double doublings = std::log2(all / done);
    const double sum = shrinks * (1 - std::pow(shrinks, doublings)) / (1 - shrinks);
    return now * std::pow(now / at_half, sum);
}

void FactorMemory::check_counts(const PairCounts& counts) const {
    refuse_above(base_ + counts.bytes(), "at least ");
}

}  // namespace parallux
