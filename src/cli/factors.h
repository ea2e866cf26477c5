#pragma once

#include "cli/factors_options.h"

namespace parallux {

/// Runs `parallux factors` from the scene to the files; returns the exit code.
int find_factors(const FactorsOptions& options);

}  // namespace parallux
