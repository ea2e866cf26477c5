#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace parallux {

/// The options that change a scene before it is solved: materials, bands, names, temperatures.
void add_changes(CLI::App& app, SolveOptions& options);

/// Outputs beside pictures, tables and statistics: fluxes, sensors; and what of a table is wanted.
void add_measurements(CLI::App& app, SolveOptions& options);

/// What these options cannot know of each other. Throws Fault::usage.
void settle_changes(SolveOptions& options);

}  // namespace parallux
