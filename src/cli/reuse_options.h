#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace parallux {

struct SolveOptions;
struct SavedSolution;

/// `parallux render` and `parallux bake`: one command with two names, outputs from a result.
CLI::App* add_render(CLI::App& app, SolveOptions& options);
CLI::App* add_bake(CLI::App& app, SolveOptions& options);

/// What was typed that makes the scene and its patches, as it can be parsed again.
std::vector<std::string> scene_arguments(const CLI::App& parsed);

/// Fills in what the result was solved with, then what was typed beside it, which counts; settles
/// all. Throws Fault::input where the result's arguments are none, Fault::usage for contradictions.
void recall(const SavedSolution& result, SolveOptions& options);

}  // namespace parallux
