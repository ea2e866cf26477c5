#include "factors/methods.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <glm/geometric.hpp>

#include "factors/gauss_legendre.h"
#include "factors/open_sky.h"
#include "lines/ray_scene.h"
#include "patches/patch_values.h"
#include "random.h"
#include "solve/sobol.h"

namespace parallux::factor_bench {

namespace {

// Processor time, which a busy machine leaves alone: all methods that are judged run on one thread.
struct Clock {
    static std::clock_t now() { return std::clock(); }
};

double seconds_since(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// H = sky + F ρ H by repeated reflection, and what is kept of it.
void reflect(const Patches& patches, Answer& answer) {
    const std::size_t n = answer.sky.size();
    std::vector<double> irradiance = answer.sky, next(n);
    for (double change = 1; change > 1e-9;) {
        change = 0;
        for (std::size_t i = 0; i < n; ++i) {
            double sum = answer.sky[i];
            for (std::uint64_t k = answer.start[i]; k < answer.start[i + 1]; ++k) {
                const std::uint32_t j = answer.column[k];
                sum += answer.factor[k] *
                       static_cast<double>(patches.reflectance[j * patches.bands]) * irradiance[j];
            }
            change = std::max(change, std::abs(sum - irradiance[i]));
            next[i] = sum;
        }
        irradiance.swap(next);
    }
    answer.net.resize(n);
    for (std::size_t i = 0; i < n; ++i)
        answer.net[i] =
            (1 - static_cast<double>(patches.reflectance[i * patches.bands])) * irradiance[i];
}

// A uniform point of a triangle, and a direction by the cosine law about its normal.
struct Place {
    glm::dvec3 origin, direction;
};

Place place_of(const glm::dvec3 corner[3], const glm::dvec3 frame[3],
               const std::array<double, Sobol::dimensions>& p) {
    const double root = std::sqrt(p[0]), turn = 2 * pi * p[2], radius = std::sqrt(p[3]);
    return {(1 - root) * corner[0] + root * (1 - p[1]) * corner[1] + root * p[1] * corner[2],
            radius * std::cos(turn) * frame[0] + radius * std::sin(turn) * frame[1] +
                std::sqrt(std::max(0.0, 1 - p[3])) * frame[2]};
}

}  // namespace

Answer by_bundles(const Scene& scene, const Patches& patches, std::uint64_t bundles,
                  std::uint64_t seed, unsigned threads, SkyFrom sky_from, double lines_per_patch) {
    const auto start = Clock::now();
    FactorSettings settings;
    settings.bundles = bundles;
    settings.seed = seed;
    settings.threads = threads;
    settings.groups = 1;
    settings.sky_from = sky_from;
    settings.lines_per_patch = lines_per_patch;
    Factors factors = view_factors(scene, patches, settings);
    Answer answer;
    for (std::size_t i = 0; i < factors.nodes.size(); ++i) {
        answer.sky.push_back(factors.outside[i * factors.outsides()]);
        for (std::uint64_t k = factors.start[i]; k < factors.start[i + 1]; ++k)
            factors.exchange[k] /= factors.nodes[i].area;
    }
    answer.start = std::move(factors.start);
    answer.column = std::move(factors.column);
    answer.factor = std::move(factors.exchange);
    reflect(patches, answer);
    answer.seconds = seconds_since(start);
    return answer;
}

void with_fine_sky(const Scene& scene, const Patches& patches, Answer& answer) {
    constexpr unsigned cuts = 4;
    const SkyBlockers blockers(scene);
    SkyBlockers::View view(blockers);
    const GaussRule rule(5);
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const glm::dvec3 corner[3] = {surface_point(scene, surface, 0, 0),
                                      surface_point(scene, surface, 1, 0),
                                      surface_point(scene, surface, 0, 1)};
        view.turn(corner, surface_normal(scene, surface));
        double sum = 0;
        const SurfaceGrid grid{0, none, cuts, cuts};
        for_each_cell(Shape::triangle, grid, [&](const Cell& c) {
            for (const GaussNode& a : rule)
                for (const GaussNode& b : rule) {
                    const double x = (1 + a.place) / 2, y = (1 + b.place) / 2;
                    sum += a.weight * b.weight / 2 * x *
                           view.sky(surface_point(scene, surface, c.u0 + x * (1 - y) * c.du,
                                                  c.v0 + x * y * c.dv));
                }
        });
        answer.sky[patches.grids[s].front] = sum / (cuts * cuts);
    }
    reflect(patches, answer);
}

Answer by_rays(const Scene& scene, const Patches& patches, std::uint32_t rays, std::uint64_t seed) {
    const auto start = Clock::now();
    const RayScene tracer(scene, 1);
    const DenormalsOff fast;
    const Sobol sobol(seed);
    std::vector<std::array<double, Sobol::dimensions>> points(rays);
    for (std::uint32_t k = 0; k < rays; ++k)
        points[k] = sobol.point(k);
    Answer answer;
    std::vector<std::uint32_t> met;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const glm::dvec3 corner[3] = {scene.positions[surface.corner[0]],
                                      scene.positions[surface.corner[1]],
                                      scene.positions[surface.corner[2]]};
        const glm::dvec3 normal = surface_normal(scene, surface);
        const glm::dvec3 x = glm::normalize(corner[1] - corner[0]);
        const glm::dvec3 frame[3] = {x, glm::cross(normal, x), normal};
        // Each facet has the points moved on by a random step (R. Cranley, T. Patterson, 1976).
        Random random(seed, stream::local_gather + s);
        std::array<double, 4> moved;
        for (double& m : moved)
            m = random.uniform();
        met.clear();
        std::uint32_t sky = 0;
        for (std::array<double, Sobol::dimensions> point : points) {
            for (unsigned d = 0; d < 4; ++d)
                point[d] = std::fmod(point[d] + moved[d], 1.0);
            const Place place = place_of(corner, frame, point);
            const SurfaceHit hit = tracer.closest(place.origin, place.direction, 1e30, s);
            if (hit.surface == none)
                sky += glm::dot(place.direction, scene.sky.up) > 0;
            else if (!hit.back)
                met.push_back(patches.grids[hit.surface].front);
        }
        std::sort(met.begin(), met.end());
        for (std::size_t k = 0; k < met.size();) {
            const std::size_t begin = k;
            while (++k < met.size() && met[k] == met[begin]) {
            }
            answer.column.push_back(met[begin]);
            answer.factor.push_back(static_cast<double>(k - begin) / rays);
        }
        answer.start.push_back(answer.column.size());
        answer.sky.push_back(static_cast<double>(sky) / rays);
    }
    reflect(patches, answer);
    answer.seconds = seconds_since(start);
    return answer;
}

Answer by_solve(const Scene& scene, const Patches& patches, std::uint64_t bundles,
                std::uint64_t seed) {
    const auto start = Clock::now();
    Scene lit = scene;
    lit.sky.kind = Sky::Kind::gradient;
    lit.sky.zenith = lit.sky.horizon = Spectrum::constant(static_cast<float>(1 / pi));
    lit.sky.ground = Spectrum::constant(0);
    SolveSettings settings;
    settings.bundles = bundles;
    settings.seed = seed;
    settings.threads = 1;
    settings.groups = 1;
    const Solution solution = solve(lit, patches, settings);
    Answer answer;
    for (std::size_t i = 0; i < patches.count(); ++i)
        answer.net.push_back((1 - static_cast<double>(patches.reflectance[i * patches.bands])) *
                             static_cast<double>(solution.irradiance[i * patches.bands]));
    answer.seconds = seconds_since(start);
    return answer;
}

}  // namespace parallux::factor_bench
