#pragma once

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

/// W/m² per unit of intensity that a light brings to a point that faces `normal`, with a shadow ray
/// that leaves out the surface the point lies on. `far`: beyond all of the scene, for a directional
/// light's ray.
double light_arrives(const RayScene& rays, const Light& light, const glm::dvec3& point,
                     const glm::dvec3& normal, std::uint32_t surface, double far);

/// Adds what point, spot and directional lights send straight to each patch: the mean over
/// stratified points of the patch, a shadow ray each. O(patches · lights), in parallel.
void add_light_points(const Run& run, DirectLight& direct);

}  // namespace parallux
