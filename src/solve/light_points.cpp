#include "solve/light_points.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "lines/directions.h"
#include "parallel.h"
#include "patches/patch_values.h"
#include "random.h"
#include "solve/far_shadow.h"
#include "solve/quanta_sink.h"

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

// Of the disc that a light comes from, as it is seen from afar: places, in its radius. A spiral of
// equal areas; the four of each point of a cell lie in four rings.
constexpr int disc_places = 4;

glm::dvec2 disc_place(int point, int place) {
    constexpr int count = points_a_side * points_a_side * disc_places;
    const int k = place * points_a_side * points_a_side + point;
    const double radius = std::sqrt((k + 0.5) / count), angle = k * pi * (3 - std::sqrt(5.0));
    return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

// A surface of a cell, as light finds it.
struct Place {
    const RayScene& rays;
    glm::dvec3 point, normal;
    std::uint32_t surface;
    int number;  // of the point in its cell
    const FarShadow& shadow;

    bool sees(const glm::dvec3& toward) const { return !shadow.blocked(point, toward, surface); }
};

// W/m² per W/m² across its direction of a light from far away.
double from_afar(const Place& place, const Light& light) {
    const glm::dvec3 middle = -light.direction;
    const double cosine = glm::dot(place.normal, middle), sine = std::sin(light.half_angle);
    if (cosine <= -sine)
        return 0;
    if (light.half_angle == 0)
        return place.sees(middle) ? cosine : 0;
    glm::dvec3 x, y;
    frame_across(middle, x, y);
    double sum = 0;
    for (int k = 0; k < disc_places; ++k) {
        // Even in the disc's projection along its axis, so that a place stands for an equal share
        // of what crosses a plane across it: ∫ L cos ψ dω.
        const glm::dvec2 offset = sine * disc_place(place.number, k);
        const double along = std::sqrt(1 - glm::dot(offset, offset));
        const glm::dvec3 toward = along * middle + offset.x * x + offset.y * y;
        // A disc all above the surface brings what its middle would, exactly.
        const double share =
            cosine >= sine ? cosine : std::max(0.0, glm::dot(place.normal, toward)) / along;
        if (share > 0 && place.sees(toward))
            sum += share;
    }
    return sum / disc_places;
}

// W/m² per unit of intensity that a light brings to a place.
double arrives(const Place& place, const Light& light) {
    if (light.kind == Light::Kind::directional)
        return from_afar(place, light);
    glm::dvec3 to_light = light.position - place.point;
    double square = glm::dot(to_light, to_light);
    double distance = std::sqrt(square);
    if (distance == 0 || (light.range > 0 && distance > light.range))
        return 0;
    double cosine = glm::dot(place.normal, to_light) / distance;
    double strength = 1;
    if (light.kind == Light::Kind::spot)
        strength = smooth_cone(light, -glm::dot(light.direction, to_light) / distance);
    if (cosine <= 0 || strength <= 0 ||
        place.rays.blocked(place.point, light.position, place.surface))
        return 0;
    return strength * cosine / square;
}

}  // namespace

double light_arrives(const RayScene& rays, const FarShadow& shadow, const Light& light,
                     const glm::dvec3& point, const glm::dvec3& normal, std::uint32_t surface) {
    // All places of a disc; without one, all are the same.
    const bool disc = light.kind == Light::Kind::directional && light.half_angle > 0;
    const int numbers = disc ? points_a_side * points_a_side : 1;
    double sum = 0;
    for (int number = 0; number < numbers; ++number)
        sum += arrives({rays, point, normal, surface, number, shadow}, light);
    return sum / numbers;
}

namespace {

// What of a light meets a point of a mirror or glass, and walks on from there.
struct Beam {
    glm::dvec3 origin, direction;
    double flux = 0;  ///< W/m² per unit of the light's intensity
};

Beam beam_to(const Run& run, const Place& place, const Light& light, Random& random) {
    if (light.kind != Light::Kind::directional)
        return {light.position, glm::normalize(place.point - light.position),
                arrives(place, light)};
    glm::dvec3 x, y;
    frame_across(-light.direction, x, y);
    double square = 0;
    const glm::dvec2 offset = std::sin(light.half_angle) * uniform_disk(random, square);
    const double along = std::sqrt(1 - glm::dot(offset, offset));
    const glm::dvec3 toward = offset.x * x + offset.y * y - along * light.direction;
    const double flux = glm::dot(place.normal, toward) / along;
    if (flux <= 0 || !place.sees(toward))
        return {};
    return {place.point + 4 * run.plan.sphere.radius * toward, -toward, flux};
}

// A cell that mirrors, or is glass: what each light sends it walks on from random points of it, as
// many as its share of the area of all such cells asks for.
void walk_from_cell(const Run& run, const FarShadow& shadow, std::size_t s, const Cell& cell,
                    std::uint32_t patch, const glm::dvec3& normal, double cell_area,
                    double walks_an_area, unsigned worker) {
    const Scene& scene = run.scene;
    const std::uint32_t bands = run.patches.bands;
    const Surface& surface = scene.surfaces[s];
    const auto walks =
        static_cast<std::uint64_t>(std::max(1.0, std::ceil(walks_an_area * cell_area)));
    const QuantaSink sink = bank_sink(run, worker);
    // Surfaces may share a patch.
    Random random(mix64(run.settings.seed + s), stream::light_walks + patch);
    for (std::uint64_t k = 0; k < walks; ++k) {
        double a = random.uniform(), b = random.uniform();
        if (surface.shape() == Shape::triangle && a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        const Place place{
            *run.rays, surface_point(scene, surface, cell.u0 + a * cell.du, cell.v0 + b * cell.dv),
            normal,    static_cast<std::uint32_t>(s),
            0,         shadow};
        for (const Light& light : scene.lights) {
            const Beam beam = beam_to(run, place, light, random);
            if (beam.flux <= 0)
                continue;
            const double watts = beam.flux * cell_area / static_cast<double>(walks);
            Quanta quanta{};
            for (std::uint32_t band = 0; band < bands; ++band) {
                quanta[band] =
                    std::llrint(watts * light.intensity[band] / run.plan.watts_per_quantum);
                run.banks.totals(worker).sky[band] += quanta[band];
            }
            carry(Walk(*run.walks, beam.origin, beam.direction), quanta, bands, random, sink);
        }
    }
}

// Of a group's walks from each light, those a square metre of mirrors and glass.
double walks_an_area(const Run& run) {
    double area = 0;
    for (std::size_t patch = 0; patch < run.patches.specular.size(); ++patch)
        area += run.patches.specular[patch] > 0 ? run.patches.area[patch] : 0;
    return area > 0 ? static_cast<double>(run.plan.light_walks) / area : 0;
}

// A surface's cells, one after the other.
void light_surface(const Run& run, const FarShadow& shadow, std::size_t s, double walks,
                   unsigned worker) {
    const Scene& scene = run.scene;
    const std::uint32_t bands = run.patches.bands;
    const Surface& surface = scene.surfaces[s];
    const SurfaceGrid& grid = run.patches.grids[s];
    const glm::dvec3 front = surface_normal(scene, surface);
    const double cell_area =
        surface_area(scene, surface) / (static_cast<double>(grid.nu) * grid.nv);
    const bool triangle = surface.shape() == Shape::triangle;
    for (std::uint32_t first : {grid.front, grid.back}) {
        if (first == none)
            continue;
        const glm::dvec3 normal = first == grid.front ? front : -front;
        for_each_cell(surface.shape(), grid, [&](const Cell& cell) {
            if (run.patches.specular_share(first + cell.index) > 0) {
                walk_from_cell(run, shadow, s, cell, first + cell.index, normal, cell_area, walks,
                               worker);
                return;
            }
            double watts[max_bands] = {};
            for (int k = 0; k < points_a_side * points_a_side; ++k) {
                double a = (k % points_a_side + 0.5) / points_a_side;
                double b = (k / points_a_side + 0.5) / points_a_side;
                if (triangle && a + b > 1) {
                    a = 1 - a;
                    b = 1 - b;
                }
                const glm::dvec3 point =
                    surface_point(scene, surface, cell.u0 + a * cell.du, cell.v0 + b * cell.dv);
                const Place place{*run.rays, point, normal, static_cast<std::uint32_t>(s),
                                  k,         shadow};
                for (const Light& light : scene.lights) {
                    const double flux =
                        arrives(place, light) * cell_area / (points_a_side * points_a_side);
                    for (std::uint32_t band = 0; flux > 0 && band < bands; ++band)
                        watts[band] += flux * light.intensity[band];
                }
            }
            for (std::uint32_t band = 0; band < bands; ++band) {
                const std::int64_t quanta = std::llrint(watts[band] / run.plan.watts_per_quantum);
                run.banks.receive(worker, (first + cell.index) * std::size_t(bands) + band, quanta);
                run.banks.totals(worker).sky[band] += quanta;
            }
        });
    }
}

}  // namespace

void add_light_points(const Run& run, DirectLight& direct, std::uint64_t& done) {
    if (run.scene.lights.empty())
        return;
    const FarShadow shadow(*run.rays, run.scene);
    const double walks = walks_an_area(run);
    direct.arrived = true;
    // In slabs of about so many cells, so that the caller is heard now and then.
    constexpr std::uint64_t slab = 1 << 17;
    const std::size_t surfaces = run.scene.surfaces.size();
    while (done < surfaces) {
        std::uint64_t end = done, cells = 0;
        for (; end < surfaces && cells < slab; ++end)
            cells += std::uint64_t(run.patches.grids[end].nu) * run.patches.grids[end].nv;
        parallel_for(run.plan.threads, end - done, 16,
                     [&](std::size_t first, std::size_t last, unsigned worker) {
                         for (std::size_t s = first; s < last; ++s)
                             light_surface(run, shadow, done + s, walks, worker);
                     });
        done = end;
        run.listener.go_on("first shot", static_cast<double>(done) / static_cast<double>(surfaces),
                           0);
    }
    run.banks.take_totals(direct.emitted, direct.escaped, direct.absorbed);
}

}  // namespace parallux
