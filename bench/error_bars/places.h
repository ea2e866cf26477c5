#pragma once

#include <string>
#include <vector>

#include "parallux/parallux.h"

namespace parallux::error_bars {

/// A scene that is solved many times over.
struct Place {
    std::string name;
    Scene scene;
    Patches patches;
};

/// Where intervals are tried:
///  paper-456       the paper's scene 2, one band
///  cornell-closed  the Cornell box with a front wall, three bands
///  street          a street under a sky, open, three bands
/// and, for slopes, paper-600, paper-1824 and paper-12150. `tiny`: in fewer patches.
Place make_place(const std::string& name, bool tiny);

std::vector<std::string> interval_places(bool tiny = false);
std::vector<std::string> slope_places(bool tiny = false);

}  // namespace parallux::error_bars
