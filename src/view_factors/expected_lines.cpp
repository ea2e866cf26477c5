#include "view_factors/expected_lines.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "surfaces/curve.h"

namespace parallux {

ExpectedLines::ExpectedLines(const Scene& scene, const Patches& patches, const NodeMap& nodes)
    : nodes_(nodes.nodes.size()) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        if (scene.surfaces[s].is_curved()) {
            add_curved(scene.curves[scene.surfaces[s].curve], grid, nodes);
            continue;
        }
        const std::uint32_t cells = grid.nu * grid.nv;
        const glm::dvec3 cell = surface_normal(scene, scene.surfaces[s]) *
                                (surface_area(scene, scene.surfaces[s]) / cells);
        for (std::uint32_t side : {grid.front, grid.back}) {
            const std::size_t begin = pieces_.size();
            for (std::uint32_t k = 0; side != none && k < cells; ++k) {
                const std::uint32_t node = nodes.of_patch[side + k];
                if (pieces_.size() > begin && pieces_.back().node == node)
                    pieces_.back().area += cell;
                else
                    pieces_.push_back({node, cell});
            }
        }
    }
}

// Each cell as 4 × 4 parts, taken for flat.
void ExpectedLines::add_curved(const Curve& curve, const SurfaceGrid& grid, const NodeMap& nodes) {
    constexpr std::uint32_t parts = 4;
    const std::uint32_t nu = parts * grid.nu, nv = parts * grid.nv;
    for (std::uint32_t side : {grid.front, grid.back})
        for (std::uint32_t k = 0; side != none && k < nu * nv; ++k) {
            const std::uint32_t iu = k % nu, iv = k / nu;
            const std::uint32_t node = nodes.of_patch[side + iv / parts * grid.nu + iu / parts];
            const double u = double(iu) / nu, v = double(iv) / nv;
            pieces_.push_back({node, curve_normal(curve, u + 0.5 / nu, v + 0.5 / nv) *
                                         curve_area(curve, u, u + 1.0 / nu, v, v + 1.0 / nv)});
        }
}

void ExpectedLines::of(const Bundle& bundle, std::vector<double>& lines) const {
    const glm::dvec3 across = bundle.direction / (bundle.spacing * bundle.spacing);
    lines.assign(nodes_, 0);
    for (const Piece& piece : pieces_)
        lines[piece.node] += std::abs(glm::dot(piece.area, across));
}

}  // namespace parallux
