#include "view_factors/expected_lines.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {

ExpectedLines::ExpectedLines(const Scene& scene, const Patches& patches, const NodeMap& nodes)
    : nodes_(nodes.nodes.size()) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
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

void ExpectedLines::of(const Bundle& bundle, std::vector<double>& lines) const {
    const glm::dvec3 across = bundle.direction / (bundle.spacing * bundle.spacing);
    lines.assign(nodes_, 0);
    for (const Piece& piece : pieces_)
        lines[piece.node] += std::abs(glm::dot(piece.area, across));
}

}  // namespace parallux
