#pragma once

#include "parallux/lightmap.h"

namespace parallux {

/// A chart's grid of texels over its surface's (u, v): `cells_u` × `cells_v` squares, with a texel
/// on each of their corners or, flat, in their middles.
struct ChartGrid {
    Shape shape = Shape::parallelogram;
    std::uint32_t cells_u = 1, cells_v = 1;
    bool flat = false;

    std::uint32_t width() const { return flat ? cells_u : cells_u + 1; }
    std::uint32_t height() const { return flat ? cells_v : cells_v + 1; }
    /// (u, v) of a texel; flat texels of triangles lie in the square's lower half.
    glm::dvec2 uv(std::uint32_t i, std::uint32_t j) const;
    /// Where (u, v) lies, in texels from the first inner texel's outer corner.
    glm::dvec2 texel(const glm::dvec2& uv) const;
    /// Of a triangle's texels those with i + j up to this lie on it.
    std::uint32_t last_diagonal() const { return flat ? cells_u - 1 : cells_u; }
};

/// The texels that a chart owns in each direction: inner ones, padding, made even.
std::uint32_t owned_texels(std::uint32_t inner);

/// The grids of all charts, by surface, fronts before backs; `scale` 1: as the patches have them.
std::vector<ChartGrid> chart_grids(const Scene& scene, const Patches& patches, bool flat,
                                   double scale);

/// Lays charts into the lightmap: sets its size and its charts, and returns their grids. Throws
/// Fault::usage where they do not fit.
std::vector<ChartGrid> lay_charts(const Scene& scene, const Patches& patches, Lightmap& lightmap);

}  // namespace parallux
