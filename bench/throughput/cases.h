#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallux/patches.h"
#include "parallux/scene.h"
#include "parallux/solve.h"

namespace parallux::throughput {

/// What the command line may change of a case; 0: as the case says.
struct CaseSettings {
    std::uint64_t patches = 0;
    std::uint64_t bundles = 0;
    double lines_per_bundle = 0;
    bool tiny = false;
};

/// A scene and the one solve of it that all engines work on.
struct Case {
    std::string name;
    Scene scene;
    Patches patches;
    double spacing = 0;         ///< δ, metres
    std::uint64_t bundles = 0;  ///< of the bundle engine
    double lines_per_bundle = 0;

    /// The settings of that solve: no first shot, since only the global pass is timed.
    SolveSettings settings(unsigned threads) const;
};

/// The cases that run where none is named.
const std::vector<std::string>& case_names();

/// Builds a case by its name, or from a scene file. Throws Fault::input where there is none.
Case make_case(const std::string& name, const CaseSettings& settings = {});

/// Whether a named case can be built here: the kitchen is a file that not every machine has.
bool available(const std::string& name);

}  // namespace parallux::throughput
