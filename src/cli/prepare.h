#pragma once

#include "cli/options.h"
#include "cli/outputs.h"

namespace parallux {

/// What a solve works on, or what a result is of.
struct Prepared {
    Scene scene;
    Patches patches;
    Measurements measured;
    double loaded = 0, divided = 0;  ///< seconds since the program's start
};

/// Checks the outputs, reads the scene and what is measured, changes it as the options say, and
/// divides it. Sets the options' object_lightmaps.
Prepared prepare(SolveOptions& options);

/// Makes outputs from the result that the options name; returns the exit code.
int reuse_result(SolveOptions options);

}  // namespace parallux
