#pragma once

#include <filesystem>

#include "parallux/scene.h"

namespace CLI {
class App;
}

namespace parallux {

/// The scene's file, and how it is read: scale, what it does not say itself, sky, sun and period.
void add_scene(CLI::App& app, std::filesystem::path& scene, LoadSettings& load);

}  // namespace parallux
