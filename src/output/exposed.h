#pragma once

#include <vector>

#include "lines/ray_scene.h"
#include "output/pieces.h"
#include "parallux/patches.h"

namespace parallux {

/// What a picture knows of a patch: its part that light can reach.
struct ExposedPatch {
    glm::dvec3 mean{0};    ///< centroid of the exposed part, where its irradiance holds
    glm::dvec3 seen{0};    ///< the exposed point nearest to it
    glm::dvec3 normal{0};  ///< unit, of the patch's side
    double share = 1;      ///< exposed area / area; 0: wholly hidden
    Spectrum cover;        ///< irradiance that the hidden part gets from a lamp close above it
    double area = 0;       ///< of the exposed part, m²
    double size = 0;       ///< side of a square about as large, or as long
    double extent = 0;     ///< from the mean to the farthest corner
    std::uint32_t surface = none;
    bool cluster = false;
    bool torn = false;  ///< another surface stands across it: its value mixes two sides
};

/// Finds the exposed part of every patch: a point is hidden where another surface lies upon it (a
/// box stands there), or where it looks at nothing but the backs of one-sided surfaces (it is in a
/// solid), or where a lamp hangs so close above it that the lamp's own light is all it gets.
/// Irradiance of a patch is then (H - cover) / share on the exposed part.
/// Linear in patches and pieces, parallel, the same for any number of threads.
std::vector<ExposedPatch> exposed_patches(const Scene& scene, const Patches& patches,
                                          const Pieces& pieces, const RayScene& rays,
                                          unsigned threads);

}  // namespace parallux
