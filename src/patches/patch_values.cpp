#include "patches/patch_values.h"

#include <algorithm>
#include <cmath>

namespace parallux {

namespace {

bool varies(const Scene& scene, const Surface& surface) {
    const Material& material = scene.materials[surface.material];
    return !scene.attributes.empty() || material.reflectance_texture != none ||
           material.emission_texture != none;
}

// Mean over the cell of the material's values, by the middle points of n × n equal parts.
struct CellValues {
    double reflectance[max_bands] = {};
    double transmittance[max_bands] = {};
    double emission[max_bands] = {};
};

CellValues average(const Scene& scene, std::uint32_t s, const Cell& cell, Shape shape, int n,
                   bool back) {
    CellValues mean;
    int points = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double a = (i + 0.5) / n, b = (j + 0.5) / n;
            // The mirror image across the diagonal keeps points in a triangle, evenly.
            if (shape == Shape::triangle && a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            double u = cell.u0 + a * cell.du, v = cell.v0 + b * cell.dv;
            Spectrum reflectance = surface_reflectance(scene, s, u, v, back);
            Spectrum emission = surface_emission(scene, s, u, v);
            for (std::uint32_t band = 0; band < scene.bands; ++band) {
                mean.reflectance[band] += reflectance[band];
                mean.emission[band] += emission[band];
            }
            ++points;
        }
    for (std::uint32_t band = 0; band < scene.bands; ++band) {
        mean.reflectance[band] /= points;
        mean.emission[band] /= points;
        const Material& material = scene.materials[scene.surfaces[s].material];
        mean.transmittance[band] = std::min(0.999f, material.transmittance_of(back)[band]);
    }
    return mean;
}

// Makes room for transmittances where a surface has any.
void find_other_sides(const Scene& scene, std::size_t count, Patches& patches) {
    patches.transmittance.clear();
    patches.other.clear();
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        if (grid.back == none || !scene.materials[scene.surfaces[s].material].is_translucent())
            continue;
        patches.transmittance.resize(count * patches.bands, 0);
        patches.other.resize(count, none);
        for (std::uint32_t cell = 0; cell < grid.nu * grid.nv; ++cell) {
            patches.other[grid.front + cell] = grid.back + cell;
            patches.other[grid.back + cell] = grid.front + cell;
        }
    }
}

// Makes room for what mirrors and glass take where there are any, and sets it.
void set_specular(const Scene& scene, std::size_t count, Patches& patches) {
    patches.specular.clear();
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const float share = scene.materials[scene.surfaces[s].material].specular_share();
        if (share == 0)
            continue;
        patches.specular.resize(count, 0);
        const SurfaceGrid& grid = patches.grids[s];
        for (std::uint32_t first : {grid.front, grid.back})
            if (first != none)
                std::fill_n(&patches.specular[first], grid.nu * grid.nv, share);
    }
}

}  // namespace

void set_patch_values(const Scene& scene, const std::vector<double>& surface_areas,
                      std::size_t count, Patches& patches) {
    std::uint32_t bands = scene.bands;
    patches.area.assign(count, 0);
    patches.reflectance.assign(count * bands, 0);
    patches.emission.assign(count * bands, 0);
    find_other_sides(scene, count, patches);
    set_specular(scene, count, patches);

    // Areas first, since values are means weighted by area.
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        std::uint32_t cells = grid.nu * grid.nv;
        for (std::uint32_t cell = 0; cell < cells; ++cell)
            for (std::uint32_t first : {grid.front, grid.back})
                if (first != none)
                    patches.area[first + cell] += surface_areas[s] / cells;
    }
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const SurfaceGrid& grid = patches.grids[s];
        double cell_area = surface_areas[s] / (static_cast<double>(grid.nu) * grid.nv);
        bool fine = cell_area < 0.25 * patches.size * patches.size;
        int points = varies(scene, surface) ? (fine ? 2 : 8) : 1;
        const bool own_back = scene.materials[surface.material].own_back;
        CellValues sides[2];
        for_each_cell(surface.shape(), grid, [&](const Cell& cell) {
            if (points > 1 || cell.index == 0) {
                sides[0] = average(scene, s, cell, surface.shape(), points, false);
                sides[1] =
                    own_back ? average(scene, s, cell, surface.shape(), points, true) : sides[0];
            }
            for (bool back : {false, true}) {
                const std::uint32_t first = back ? grid.back : grid.front;
                if (first == none)
                    continue;
                const CellValues& values = sides[back];
                std::size_t patch = first + cell.index;
                double weight = cell_area / patches.area[patch];
                // A patch of one surface takes the values as they are, to the last bit.
                if (weight > 1 - 1e-9)
                    weight = 1;
                for (std::uint32_t band = 0; band < bands; ++band) {
                    patches.reflectance[patch * bands + band] +=
                        static_cast<float>(weight * values.reflectance[band]);
                    patches.emission[patch * bands + band] +=
                        static_cast<float>(weight * values.emission[band]);
                    if (patches.translucent())
                        patches.transmittance[patch * bands + band] +=
                            static_cast<float>(weight * values.transmittance[band]);
                }
            }
        });
    }
}

}  // namespace parallux
