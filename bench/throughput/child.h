#pragma once

#include <cstdint>
#include <string>

#include "throughput/cases.h"

namespace parallux::throughput {

/// One solve by bundles in a process of its own.
struct ChildRun {
    std::uint64_t patches = 0;
    double lines_per_bundle = 0;
    std::uint64_t bundles = 0;
    double lines_per_second = 0;
    std::uint64_t peak_bytes = 0;  ///< resident, from reading the scene to the result

    double bytes_per_patch() const {
        return static_cast<double>(peak_bytes) / static_cast<double>(patches);
    }
};

/// Builds the case and solves it in a forked child, whose peak is that run's alone. Call it before
/// this process has started any thread. Throws what the run throws.
ChildRun run_in_child(const std::string& name, const CaseSettings& settings, unsigned threads);

/// Prints time a line and bytes a patch of the paper's scene from 10⁴ to 10⁷ patches.
void sweep();

}  // namespace parallux::throughput
