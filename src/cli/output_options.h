#pragma once

namespace CLI {
class App;
}

namespace parallux {

struct SolveOptions;

/// Pictures, tables and statistics.
void add_outputs(CLI::App& app, SolveOptions& options);

/// What only a run can write: the solution itself, pictures while it goes on.
void add_run_outputs(CLI::App& app, SolveOptions& options);

/// Bakes and lightmaps.
void add_bakes(CLI::App& app, SolveOptions& options);

}  // namespace parallux
