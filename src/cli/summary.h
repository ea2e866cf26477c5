#pragma once

#include <string>

#include "cli/options.h"

namespace parallux {

/// Before a solve: the line on standard output that says how much memory it will take.
void tell_memory(std::uint64_t bytes);

/// A few lines on standard output on what a solve did, then the warnings on standard error.
void tell_summary(const SolveOptions& options, const Scene& scene, const Patches& patches,
                  const Solution& solution);

/// The same on outputs made from a result.
void tell_reuse(const SolveOptions& options, const Scene& scene, const Patches& patches,
                const SavedSolution& result);

/// A line on the balance of net fluxes.
std::string describe_fluxes(const Fluxes& fluxes);

/// Lines on how two tables differ.
std::string describe_comparison(const Comparison& comparison);

}  // namespace parallux
