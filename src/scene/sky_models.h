#pragma once

#include <optional>
#include <string>

#include "parallux/scene.h"

namespace parallux {

/// Puts a sky, its ground and its sun over a scene, in place of those it has; model from_file
/// leaves the sky and replaces suns alone. Returns what is wrong with the settings for this scene,
/// if anything; the scene is then as it was.
std::optional<std::string> put_sky(Scene& scene, const SkySettings& settings);

/// Makes the periods lie exactly across the sky's up. Returns what is wrong with them, if anything.
std::optional<std::string> settle_period(Scene& scene);

/// The unit vector toward a place in the sky: elevation above the horizon, azimuth from the sky's
/// north by east, radians.
glm::dvec3 sky_direction(const Sky& sky, double elevation, double azimuth);

/// CIE standard clear sky: type 12 of ISO 15469:2004 (CIE S 011); not normalised, nor is
SkyShape clear_shape(const glm::dvec3& sun);

/// Perez's all-weather sky. Irradiances in W/m²: of the sun across its direction,
/// and diffuse on a horizontal plane, more than 0.
SkyShape perez_shape(const glm::dvec3& sun, double elevation, double direct, double diffuse);

}  // namespace parallux
