#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace parallux {

/// The options that change a scene before it is solved: materials, bands, names, temperatures.
void add_changes(CLI::App& app, SolveOptions& options);

/// Outputs beside pictures, tables and statistics: sensors; and what of a table or PNG is wanted.
void add_measurements(CLI::App& app, SolveOptions& options);

/// Net fluxes, which only a run can tell: it shows its groups one by one.
void add_fluxes(CLI::App& app, SolveOptions& options);

/// What these options cannot know of each other. Throws Fault::usage.
void settle_changes(SolveOptions& options);

}  // namespace parallux
