#pragma once

#include <string>

#include "cli/options.h"

namespace parallux {

/// What a scene holds, for people or as one JSON object with the same entries; with the expected
/// error of lines through it where that is asked for. Linear.
std::string describe_scene(const Scene& scene, const InfoOptions& options);

}  // namespace parallux
