#pragma once

#include <cstddef>
#include <vector>

#include "parallux/patches.h"

namespace parallux {

/// One cell of a surface's grid: its number, its place, and three corners or four in (u, v).
struct Cell {
    std::uint32_t index, iu, iv;
    double centre_u, centre_v;
    double u0, v0;  ///< corner at the origin of the cell's own axes
    double du, dv;  ///< the cell's axes: (du, 0) and (0, dv); negative in inverted triangles
};

/// Calls visit(Cell) for all cells of a grid in patch order.
template <class Visit>
void for_each_cell(Shape shape, const SurfaceGrid& grid, Visit&& visit) {
    double du = 1.0 / grid.nu, dv = 1.0 / grid.nv;
    std::uint32_t index = 0;
    for (std::uint32_t iv = 0; iv < grid.nv; ++iv) {
        if (shape == Shape::parallelogram) {
            for (std::uint32_t iu = 0; iu < grid.nu; ++iu)
                visit(Cell{index++, iu, iv, (iu + 0.5) * du, (iv + 0.5) * dv, iu * du, iv * dv, du,
                           dv});
            continue;
        }
        // Upright and inverted triangles in turn; each centroid is a third of the way.
        std::uint32_t in_row = 2 * (grid.nv - iv) - 1;
        for (std::uint32_t k = 0; k < in_row; ++k) {
            double sign = k % 2 ? -1 : 1;
            double u0 = (k / 2 + (k % 2)) * du, v0 = (iv + (k % 2)) * dv;
            visit(Cell{index++, k, iv, u0 + sign * du / 3, v0 + sign * dv / 3, u0, v0, sign * du,
                       sign * dv});
        }
    }
}

/// Fills area, reflectance and emission of `count` patches from the surfaces that map to them;
/// textures and vertex colours are averaged over points spread over each cell. Linear.
void set_patch_values(const Scene& scene, const std::vector<double>& surface_areas,
                      std::size_t count, Patches& patches);

}  // namespace parallux
