#pragma once

#include <cstdint>
#include <vector>

#include "parallux/scene.h"

namespace parallux {

/// Joins surfaces of less than half of size² into clusters of about size²: connected by edges, of
/// one material, normals within `crease` radians of the first one's, not farther than `size` from
/// it. Sets cluster_of (none: the surface keeps its own grid) and returns the number of clusters.
/// O(n log n) in the surfaces.
std::uint32_t grow_clusters(const Scene& scene, const std::vector<double>& surface_areas,
                            double size, double crease, std::vector<std::uint32_t>& cluster_of);

}  // namespace parallux
