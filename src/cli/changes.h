#pragma once

#include "cli/options.h"

namespace parallux {

/// Leaves surfaces out and gives materials and temperatures, as the options say; checks that the
/// scene has as many bands, and the names, as the outputs want. Throws Fault::usage or
/// Fault::input.
void change_scene(const SolveOptions& options, Scene& scene);

/// The temperatures of single patches. Throws Fault::input.
void change_patches(const SolveOptions& options, Patches& patches);

}  // namespace parallux
