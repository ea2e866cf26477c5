#include "view_factors/memory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <unistd.h>

#include "lines/periodic.h"
#include "parallux/error.h"
#include "view_factors/pair_sweep.h"

namespace parallux {

namespace {

// A pair in a table that is three quarters to half full; or, after counting, on one side of the
// matrix and on both, with a copy where entries are left out.
constexpr std::uint64_t bytes_a_pair = 64;

std::uint64_t machine_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

FactorMemory::FactorMemory(const Scene& scene, const Patches& patches, std::size_t nodes,
                           std::uint32_t outsides, unsigned threads, std::uint64_t max_memory)
    : limit_(max_memory ? max_memory : machine_memory()) {
    // The program, what buffers hold, surfaces as read and as projected.
    base_ = (std::uint64_t(60) << 20) + (std::uint64_t(64) << 20) +
            threads * (std::uint64_t(4) << 20) +
            scene.surfaces.size() * (sizeof(Surface) + sizeof(SurfaceGrid) + 64) +
            scene.positions.size() * (sizeof(glm::dvec3) + 12);
    base_ += PairSweep::bundles_at_once(scene, threads) * copies_bytes(scene);
    base_ += patches.count() * (8 + patches.bands * 8 + 4 + sizeof(PatchPlace));
    base_ += nodes * (sizeof(FactorNode) + 16 * 8) + nodes * outsides * (4 * 8 + 2 * 8);
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

std::uint64_t FactorMemory::check_pairs(const PairCounts::Pairs& pairs, double done,
                                        double all) const {
    const double seen = static_cast<double>(pairs.all), once = static_cast<double>(pairs.once);
    const double twice = std::max(1.0, static_cast<double>(pairs.twice));
    const double unseen = once * once / (2 * twice);
    const double more = all / done - 1;
    const double found = unseen > 0 ? unseen * (1 - std::exp(-more * once / unseen)) : 0;
    const std::uint64_t bytes =
        base_ + static_cast<std::uint64_t>((seen + found) * static_cast<double>(bytes_a_pair));
    refuse_above(bytes, "about ");
    return bytes;
}

void FactorMemory::check_tables(const PairCounts& counts) const {
    refuse_above(base_ + counts.table_bytes(), "at least ");
}

}  // namespace parallux
