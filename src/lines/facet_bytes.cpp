#include "lines/facets.h"
#include "parallux/lines.h"
#include "surfaces/curve.h"

namespace parallux {

double facet_chord(const Scene& scene, double spacing) {
    return (spacing > 0 ? spacing : 1e-3 * line_sphere(scene).radius) / 8;
}

std::uint64_t facets_bytes(const Scene& scene, const Patches& patches, double spacing,
                           std::uint64_t projections) {
    if (!has_curves(scene))
        return 0;
    std::uint64_t facets = 0, corners = 0;
    const double chord = facet_chord(scene, spacing);
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        if (!surface.is_curved() || is_whole_sphere(scene.curves[surface.curve]))
            continue;
        const Curve& curve = scene.curves[surface.curve];
        const std::uint64_t u =
            curve_cuts(curve, true, patches.grids[s].nu, chord, facet_bend).size();
        const std::uint64_t v =
            curve_cuts(curve, false, patches.grids[s].nv, chord, facet_bend).size();
        facets += 2 * (u - 1) * (v - 1);
        corners += u * v;
    }
    // Arrays that grow hold up to twice their content.
    const std::uint64_t a_facet = 2 * (sizeof(Surface) + sizeof(SurfaceGrid) + 4);
    return facets * (a_facet + 8 * projections) +
           corners * (2 * sizeof(glm::dvec3) + 4 + 12 * projections);
}

}  // namespace parallux
