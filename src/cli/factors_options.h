#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "parallux/factors.h"

namespace CLI {
class App;
}

namespace parallux {

struct FactorsOptions {
    std::filesystem::path scene;
    LoadSettings load;
    std::vector<std::string> exclude;  ///< objects or materials
    PatchSettings patches;
    bool patches_asked = false;
    bool facets = false;  ///< one patch a triangle of the file, or parallelogram of a JSON scene
    FactorSettings factors;
    FactorValues values = FactorValues::exchange;
    std::filesystem::path matrix, sky, stats;  ///< empty: not wanted
    bool quiet = false;

    /// Beside the matrix: its name with .areas.csv for its ending.
    std::filesystem::path areas() const;
};

/// Adds `parallux factors` to the command line.
CLI::App* add_factors(CLI::App& app, FactorsOptions& options);

/// What single options cannot know of each other. Lengths become metres.
void settle(FactorsOptions& options);

}  // namespace parallux
