#pragma once

#include <string>

#include "parallux/scene.h"

namespace parallux {

/// What a scene holds, for people or as one JSON object with the same entries. Linear.
std::string describe_scene(const Scene& scene, bool json);

}  // namespace parallux
