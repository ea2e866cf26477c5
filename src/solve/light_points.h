#pragma once

#include "solve/direct_light.h"
#include "solve/far_shadow.h"
#include "solve/run.h"

namespace parallux {

/// W/m² per unit of intensity that a light brings to a point that faces `normal`, with a shadow ray
/// that leaves out the surface the point lies on, or 64 over the disc of a light that has one.
double light_arrives(const RayScene& rays, const FarShadow& shadow, const Light& light,
                     const glm::dvec3& point, const glm::dvec3& normal, std::uint32_t surface);

/// Adds what point, spot and directional lights send straight to each patch: the mean over
/// 4 × 4 points of each cell, a shadow ray each, four over the disc of a light that has one. The
/// points are the same in every run, so that shadows' edges are off by up to about a sixteenth of a
/// cell, which no error bar shows. O(patches · lights), in parallel. Begins behind the first `done`
/// surfaces, which counts on; asks the run's listener now and then, and ends all the same.
void add_light_points(const Run& run, DirectLight& direct, std::uint64_t& done);

}  // namespace parallux
