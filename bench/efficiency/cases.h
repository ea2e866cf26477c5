#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux::efficiency {

/// A scene and its patches, which all methods share.
struct Case {
    std::string name;
    Scene scene;
    Patches patches;
    std::vector<double> weight;     ///< of a patch in every mean: its area, 0 where it emits
    std::uint64_t emitters = 0;     ///< surfaces that emit
    std::uint64_t fingerprint = 0;  ///< over geometry, division, reflectance and emission
};

/// The cases that run where none is named.
const std::vector<std::string>& case_names();

/// The case of --tiny.
inline const char* const tiny_case = "paper-114";

/// Whether a named case can be built here: some are files that not every machine has.
bool available(const std::string& name);

/// Builds a case by its name, or from a scene file in 10 000 patches. Throws Fault::input where
/// there is none.
Case make_case(const std::string& name);

}  // namespace parallux::efficiency
