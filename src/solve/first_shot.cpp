#include "solve/first_shot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "parallel.h"
#include "patches/patch_values.h"
#include "solve/light_points.h"
#include "solve/sobol.h"

namespace parallux {

namespace {

// One emitting cell and side of one surface.
struct Emitter {
    std::uint32_t surface, patch;
    bool back;
    Cell cell;
    std::array<std::int64_t, max_bands> quanta{};  // of one ray
};

struct Emitters {
    std::vector<Emitter> pieces;
    std::vector<double> up_to;  // running share of the power, of all pieces
};

Emitters emitters_of(const Scene& scene, const Patches& patches, std::uint64_t rays,
                     double watts_per_quantum) {
    Emitters emitters;
    std::vector<double> power;
    double total = 0;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        double cell_area =
            surface_area(scene, scene.surfaces[s]) / (static_cast<double>(grid.nu) * grid.nv);
        for (std::uint32_t first : {grid.front, grid.back}) {
            if (first == none)
                continue;
            for_each_cell(scene.surfaces[s].shape(), grid, [&](const Cell& cell) {
                std::uint32_t patch = first + cell.index;
                double watts = 0;
                for (std::uint32_t band = 0; band < patches.bands; ++band)
                    watts += cell_area * patches.emission[patch * patches.bands + band];
                if (watts <= 0)
                    return;
                emitters.pieces.push_back({s, patch, first == grid.back, cell, {}});
                power.push_back(watts);
                emitters.up_to.push_back(total += watts);
            });
        }
    }
    // A ray of band b carries (power of b) / (share of the rays · rays).
    for (std::size_t k = 0; k < emitters.pieces.size(); ++k) {
        Emitter& emitter = emitters.pieces[k];
        double sum = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band)
            sum += patches.emission[emitter.patch * patches.bands + band];
        for (std::uint32_t band = 0; band < patches.bands; ++band) {
            double share = patches.emission[emitter.patch * patches.bands + band] / sum;
            emitter.quanta[band] =
                std::llrint(share * total / static_cast<double>(rays) / watts_per_quantum);
        }
        emitters.up_to[k] /= total;
    }
    return emitters;
}

// A uniform point of an emitter's cell from two numbers of [0, 1).
glm::dvec3 point_on(const Scene& scene, const Emitter& emitter, double a, double b) {
    const Surface& surface = scene.surfaces[emitter.surface];
    if (surface.shape() == Shape::triangle) {
        double root = std::sqrt(a);
        a = 1 - root;
        b *= root;
    }
    return surface_point(scene, surface, emitter.cell.u0 + a * emitter.cell.du,
                         emitter.cell.v0 + b * emitter.cell.dv);
}

glm::dvec3 cosine_direction(const glm::dvec3& normal, double a, double b) {
    glm::dvec3 x, y;
    frame_across(normal, x, y);
    double r = std::sqrt(a), angle = 2 * pi * b;
    return r * std::cos(angle) * x + r * std::sin(angle) * y + std::sqrt(1 - a) * normal;
}

// The patch that a hit lands on; none: an inert back.
std::uint32_t patch_of(const Scene& scene, const Patches& patches, const SurfaceHit& hit) {
    const SurfaceGrid& grid = patches.grids[hit.surface];
    std::uint32_t first = hit.back ? grid.back : grid.front;
    if (first == none)
        return none;
    return first + cell_at(scene.surfaces[hit.surface].shape(), grid.nu, grid.nv, hit.u, hit.v);
}

struct Shooter {
    const Scene& scene;
    const Patches& patches;
    const RayScene& rays;
    const Emitters& emitters;
    Sobol sobol;

    void shoot(std::uint32_t index, DeltaBanks& banks, unsigned worker) const {
        std::array<double, Sobol::dimensions> p = sobol.point(index);
        std::size_t piece = static_cast<std::size_t>(
            std::upper_bound(emitters.up_to.begin(), emitters.up_to.end(), p[0]) -
            emitters.up_to.begin());
        const Emitter& emitter = emitters.pieces[std::min(piece, emitters.pieces.size() - 1)];
        glm::dvec3 normal = surface_normal(scene, scene.surfaces[emitter.surface]);
        glm::dvec3 direction = cosine_direction(emitter.back ? -normal : normal, p[3], p[4]);
        SurfaceHit hit = rays.closest(point_on(scene, emitter, p[1], p[2]), direction,
                                      std::numeric_limits<double>::infinity(), emitter.surface);
        std::uint32_t patch = hit.surface == none ? none : patch_of(scene, patches, hit);
        // Counted where it was emitted (in `sky`, the totals of what comes in), and where it went.
        WorkerTotals& totals = banks.totals(worker);
        for (std::uint32_t band = 0; band < patches.bands; ++band) {
            totals.sky[band] += emitter.quanta[band];
            if (patch == none)
                totals.escaped[band] += emitter.quanta[band];
            else
                banks.receive(worker, patch * std::size_t(patches.bands) + band,
                              emitter.quanta[band]);
        }
    }
};

// Rays that were stopped early stand for those not cast: a prefix of the sequence is a sample too.
void stand_for_all(DirectLight& direct, std::uint32_t bands) {
    auto scale = [&](std::int64_t& quanta) {
        quanta = std::llrint(static_cast<double>(quanta) / direct.done);
    };
    for (std::uint32_t band = 0; band < bands; ++band) {
        scale(direct.escaped[band]);
        direct.emitted[band] = direct.escaped[band];
    }
    for (std::size_t k = 0; k < direct.received.size(); ++k) {
        scale(direct.received[k]);
        direct.emitted[k % bands] += direct.received[k];
    }
}

}  // namespace

DirectLight first_shot(const Scene& scene, const Patches& patches, const RayScene& rays,
                       const FirstShotSettings& settings, DeltaBanks& banks,
                       const std::function<bool(double)>& go_on) {
    std::uint32_t bands = patches.bands;
    DirectLight direct;
    direct.received.assign(patches.count() * bands, 0);
    direct.reflected.assign(patches.count() * bands, 0);
    direct.emitted.assign(bands, 0);
    direct.escaped.assign(bands, 0);

    // Shoot from the area lights, in slabs so that the caller is heard now and then.
    std::uint64_t total = std::min<std::uint64_t>(settings.rays, 0xffffffffull);
    Emitters emitters = emitters_of(scene, patches, total, settings.watts_per_quantum);
    if (total > 0 && !emitters.pieces.empty()) {
        Shooter shooter{scene, patches, rays, emitters, Sobol(settings.seed)};
        constexpr std::uint64_t slab = 1 << 18;
        std::uint64_t done = 0;
        while (done < total) {
            std::uint64_t count = std::min(slab, total - done);
            parallel_for(settings.threads, count, 2048,
                         [&](std::size_t begin, std::size_t end, unsigned worker) {
                             for (std::size_t k = begin; k < end; ++k)
                                 shooter.shoot(static_cast<std::uint32_t>(done + k), banks, worker);
                         });
            done += count;
            direct.done = static_cast<double>(done) / static_cast<double>(total);
            if (!go_on(direct.done))
                break;
        }
    }
    banks.collect(direct.received, direct.emitted, direct.escaped);
    if (direct.done < 1)
        stand_for_all(direct, bands);

    // Add the lights without area, which have no power of their own to lose: what arrives is what
    // they emitted.
    add_light_points(scene, patches, rays, settings, direct);

    for (std::size_t k = 0; k < direct.received.size(); ++k)
        direct.reflected[k] = std::llrint(static_cast<double>(patches.reflectance[k]) *
                                          static_cast<double>(direct.received[k]));
    return direct;
}

}  // namespace parallux
