#pragma once

#include <array>
#include <string>

#include "parallux/scene.h"

// Skies and suns as options give them, for scenes whose files have none. Each throws Fault::usage
// naming the option and the value.

namespace parallux {

/// MODEL, MODEL:VALUE or MODEL:VALUE:ALBEDO.
void parse_sky(const std::string& option, const std::string& value, SkySettings& sky);

/// ELEVATION,AZIMUTH or ELEVATION,AZIMUTH,DIRECT; degrees, W/m².
void parse_sun(const std::string& option, const std::string& value, SkySettings& sky);

/// X,Y: 0 or more, not both 0.
std::array<double, 2> parse_period(const std::string& option, const std::string& value);

/// What the two cannot know of each other.
void settle_sky(const SkySettings& sky);

}  // namespace parallux
