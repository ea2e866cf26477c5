#pragma once

#include "solve/run.h"
#include "solve/small_patches.h"

// Local paths that serve the patches which are too small for a run's lines, in both ways.

namespace parallux {

struct Group;

/// Finds what arrives at small patches, beside the first shots, along 64 local paths each: by the
/// cosine law from a uniform point of the patch to what the other end sends by the pass. A path
/// that ends at a small patch goes on from there, reflected, until it ends elsewhere. Goes on
/// behind the small patches that are done; where it is stopped, the others are small no more.
void gather_locally(const Run& run, Group& group);

/// After closing_gather(), for which they were dark: adds what they send, along local
/// rays, 64 for each in the mean, and puts what gather_locally() found in its place. Takes the
/// banks. Goes on behind the rays that are done.
void shoot_locally(const Run& run, Group& group);

}  // namespace parallux
