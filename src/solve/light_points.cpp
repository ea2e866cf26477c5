#include "solve/light_points.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "parallel.h"
#include "patches/patch_values.h"

namespace parallux {

namespace {

// Points a side of a cell: 4 × 4 of them.
constexpr int points_a_side = 4;

double smooth_cone(const Light& light, double cosine) {
    // KHR_lights_punctual: full within the inner cone, falling off to the outer one.
    double inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
    if (cosine >= inner)
        return 1;
    if (cosine <= outer)
        return 0;
    double t = (cosine - outer) / (inner - outer);
    return t * t;
}

}  // namespace

double light_arrives(const RayScene& rays, const Light& light, const glm::dvec3& point,
                     const glm::dvec3& normal, std::uint32_t surface, double far) {
    if (light.kind == Light::Kind::directional) {
        double cosine = -glm::dot(normal, light.direction);
        if (cosine <= 0 || rays.blocked(point, point - far * light.direction, surface))
            return 0;
        return cosine;
    }
    glm::dvec3 to_light = light.position - point;
    double square = glm::dot(to_light, to_light);
    double distance = std::sqrt(square);
    if (distance == 0 || (light.range > 0 && distance > light.range))
        return 0;
    double cosine = glm::dot(normal, to_light) / distance;
    double strength = 1;
    if (light.kind == Light::Kind::spot)
        strength = smooth_cone(light, -glm::dot(light.direction, to_light) / distance);
    if (cosine <= 0 || strength <= 0 || rays.blocked(point, light.position, surface))
        return 0;
    return strength * cosine / square;
}

void add_light_points(const Run& run, DirectLight& direct) {
    const Scene& scene = run.scene;
    const Patches& patches = run.patches;
    if (scene.lights.empty())
        return;
    std::uint32_t bands = patches.bands;
    Bounds bounds = scene_bounds(scene);
    double far = 2 * glm::distance(bounds.low, bounds.high);
    parallel_for(
        run.plan.threads, scene.surfaces.size(), 16,
        [&](std::size_t begin, std::size_t end, unsigned worker) {
            WorkerTotals& totals = run.banks.totals(worker);
            for (std::size_t s = begin; s < end; ++s) {
                const Surface& surface = scene.surfaces[s];
                const SurfaceGrid& grid = patches.grids[s];
                glm::dvec3 front = surface_normal(scene, surface);
                double cell_area =
                    surface_area(scene, surface) / (static_cast<double>(grid.nu) * grid.nv);
                bool triangle = surface.shape() == Shape::triangle;
                for (std::uint32_t first : {grid.front, grid.back}) {
                    if (first == none)
                        continue;
                    glm::dvec3 normal = first == grid.front ? front : -front;
                    for_each_cell(surface.shape(), grid, [&](const Cell& cell) {
                        double watts[max_bands] = {};
                        for (int k = 0; k < points_a_side * points_a_side; ++k) {
                            double a = (k % points_a_side + 0.5) / points_a_side;
                            double b = (k / points_a_side + 0.5) / points_a_side;
                            if (triangle && a + b > 1) {
                                a = 1 - a;
                                b = 1 - b;
                            }
                            glm::dvec3 point = surface_point(scene, surface, cell.u0 + a * cell.du,
                                                             cell.v0 + b * cell.dv);
                            for (const Light& light : scene.lights) {
                                double flux = light_arrives(*run.rays, light, point, normal,
                                                            static_cast<std::uint32_t>(s), far) *
                                              cell_area / (points_a_side * points_a_side);
                                for (std::uint32_t band = 0; flux > 0 && band < bands; ++band)
                                    watts[band] += flux * light.intensity[band];
                            }
                        }
                        for (std::uint32_t band = 0; band < bands; ++band) {
                            std::int64_t quanta =
                                std::llrint(watts[band] / run.plan.watts_per_quantum);
                            run.banks.receive(
                                worker, (first + cell.index) * std::size_t(bands) + band, quanta);
                            totals.sky[band] += quanta;
                        }
                    });
                }
            }
        });
    direct.arrived = true;
    run.banks.take_totals(direct.emitted, direct.escaped);
}

}  // namespace parallux
