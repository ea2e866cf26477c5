#pragma once

#include <cstdint>
#include <vector>

#include "parallux/factors.h"
#include "view_factors/nodes.h"

namespace parallux {

/// Factors from nodes to the whole sky, without lines.
struct SkyShares {
    std::vector<double> sky;
    std::vector<double>
        error;  ///< what the last, finer rule of points changed: a bound in practice
};

/// Whether settings ask for sky factors from points, or whether they cost no more than two or
/// three times what counting does. They are of one tile and the sky in one part alone: Fault::usage
/// when asked for otherwise.
bool sky_from_points(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                     double line_spacing);

/// Of each cell, the mean over Gauss points of what SkyBlockers say they see of the sky; each cell
/// gets more points until they change it by less than `tolerance`, 64 at most. Equal bits on any
/// number of threads.
SkyShares sky_shares(const Scene& scene, const Patches& patches, const NodeMap& nodes,
                     double tolerance, unsigned threads);

}  // namespace parallux
