#include "reference/sky_points.h"

#include <array>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "random.h"
#include "solve/emitters.h"
#include "solve/sobol.h"

namespace parallux {

namespace {

constexpr std::uint32_t rays_a_cell = 256;

// Irradiance from the sky on one cell. Every cell takes a run of its own of one long sequence.
Spectrum sky_on(const Run& run, const Emitter& cell, const Sobol& sobol, std::uint32_t number) {
    Spectrum sum;
    for (std::uint32_t k = 0; k < rays_a_cell; ++k) {
        std::array<double, Sobol::dimensions> p = sobol.point(number * rays_a_cell + k);
        const EmitterPlace place = place_on(run.scene, cell, p[1], p[2]);
        glm::dvec3 direction = cosine_direction(place.normal, p[3], p[4]);
        SurfaceHit hit = run.rays->closest(place.point, direction,
                                           std::numeric_limits<double>::infinity(), cell.surface);
        if (hit.surface != none)
            continue;
        Spectrum radiance = run.scene.sky.radiance(direction);
        for (std::uint32_t band = 0; band < run.patches.bands; ++band)
            sum[band] += static_cast<float>(pi) * radiance[band] / rays_a_cell;
    }
    return sum;
}

}  // namespace

void add_sky_points(const Run& run, DirectLight& direct) {
    if (run.scene.sky.kind == Sky::Kind::dark)
        return;
    const std::uint32_t bands = run.patches.bands;
    const std::vector<Emitter> cells = all_cells(run.scene, run.patches);
    direct.arrived = true;
    const Sobol sobol(mix64(run.settings.seed + 1));
    std::vector<Spectrum> irradiance(cells.size());
    parallel_for(
        run.plan.threads, cells.size(), 16, [&](std::size_t begin, std::size_t end, unsigned) {
            DenormalsOff guard;
            for (std::size_t k = begin; k < end; ++k)
                irradiance[k] = sky_on(run, cells[k], sobol, static_cast<std::uint32_t>(k));
        });
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const Emitter& cell = cells[k];
        const SurfaceGrid& grid = run.patches.grids[cell.surface];
        double area = cell_area(run.scene, run.scene.surfaces[cell.surface], grid.nu, grid.nv,
                                cell.cell.iu, cell.cell.iv);
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::size_t at = cell.patch * std::size_t(bands) + band;
            std::int64_t received =
                std::llrint(area * irradiance[k][band] / run.plan.watts_per_quantum);
            run.banks.receive(0, at, received);
            direct.emitted[band] += received;
        }
    }
}

}  // namespace parallux
