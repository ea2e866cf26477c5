#pragma once

namespace CLI {
class App;
}

namespace parallux {

struct PatchSettings;
struct SolveOptions;
struct SolveSettings;

/// How surfaces are divided.
void add_patches(CLI::App& app, PatchSettings& patches);

/// The method, how long it runs, and its lines.
void add_method(CLI::App& app, SolveSettings& settings);

/// Threads and what is told, of all that makes outputs.
void add_workers(CLI::App& app, SolveOptions& options);

/// The same, memory, time, and what is told meanwhile.
void add_run(CLI::App& app, SolveOptions& options);

/// When a run is kept, and from where it is taken up.
void add_checkpoints(CLI::App& app, SolveOptions& options);

}  // namespace parallux
