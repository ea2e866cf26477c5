#pragma once

#include <cstdint>

#include "parallux/solve.h"

namespace parallux {

/// Bytes that all workers' deltas together may take.
std::uint64_t bank_limit(const SolveSettings& settings);

/// Throws Fault::memory for a run that needs more than it may take, and for a dense matrix that
/// needs more than the machine has.
void check_memory(const Scene& scene, const Patches& patches, const SolveSettings& settings);

}  // namespace parallux
