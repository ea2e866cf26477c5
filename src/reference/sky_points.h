#pragma once

#include "solve/direct_light.h"
#include "solve/run.h"

namespace parallux {

/// Adds what the sky sends straight to each patch, for methods whose rays start at patches: the
/// mean of π L over 256 cosine rays from stratified points of each cell; those that meet something
/// bring nothing. What the patches reflect of it becomes unshot. O(cells), in parallel.
void add_sky_points(const Run& run, DirectLight& direct);

}  // namespace parallux
