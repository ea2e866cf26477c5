#pragma once

#include <cstdint>
#include <vector>

#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux {

/// What is made of whole spheres: a surface for either half of each, or flat triangles.
enum class Spheres { halves, facets };

/// A scene whose curved surfaces are cut into flat triangles, each within one cell, so that what
/// projects planar surfaces projects them: every triangle is a surface of its own, with the cell's
/// patch. Planar surfaces stay as they are, in front of the others. Whole spheres are two surfaces
/// each: the half that a line meets first, and the other (is_far_half()).
struct Facets {
    Scene scene;                        ///< positions, surfaces and the curves of spheres alone
    Patches patches;                    ///< grids alone
    std::vector<std::uint32_t> parent;  ///< the surface that each was cut from
};

/// Of a chord's own length, how far it may lie from the surface.
inline constexpr double facet_bend = 1.0 / 72;

/// Chords stay within `chord` metres of the surface, and within 1/72 of their own lengths, which
/// makes areas and outlines less by 5·10⁻⁴ at most. Surfaces that share an edge, or a part of one,
/// share its corners: where one has a corner on another's edge (to 10⁻⁹ of the scene) the other
/// takes it up, so that whatever is closed stays closed, to the last line. Planar surfaces take up
/// corners too, by slivers along their edges. O(n log n). Throws Fault::memory beyond 2²⁸
/// triangles.
Facets make_facets(const Scene& scene, const Patches& patches, double chord,
                   Spheres spheres = Spheres::halves);

/// How far chords may lie from curved surfaces, for bundles of about such a spacing (0: a
/// thousandth of the scene's radius).
double facet_chord(const Scene& scene, double spacing);

/// Bytes of make_facets()'s result, and of so many projections of it. O(cuts).
std::uint64_t facets_bytes(const Scene& scene, const Patches& patches, double spacing,
                           std::uint64_t projections);

/// Of the two surfaces of a whole sphere, the one that lines meet last.
inline bool is_far_half(const Surface& surface) {
    return surface.is_curved() && surface.grid_u == 1;
}

}  // namespace parallux
