#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "lines/periodic.h"
#include "lines/ray_scene.h"
#include "parallel.h"
#include "parallux/error.h"
#include "parallux/sensors.h"
#include "solve/emitters.h"
#include "solve/far_shadow.h"
#include "solve/light_points.h"
#include "solve/shot_rays.h"
#include "solve/sobol.h"

namespace parallux {

namespace {

using Bands = std::array<double, max_bands>;

// Parts of a sensor's rays, each a sequence of its own: their spread tells the error.
constexpr std::uint32_t parts = 16;

// Readings of one part, or their sums.
struct Reading {
    Bands irradiance{}, error{};
};

class Gather {
public:
    Gather(const Scene& scene, const Patches& patches, const Solution& solution,
           const SensorSettings& settings)
        : scene_(scene),
          patches_(patches),
          solution_(solution),
          rays_(scene, settings.threads),
          rays_a_part_(static_cast<std::uint32_t>(
              std::clamp<std::uint64_t>(settings.rays / (2 * parts), 1, 1u << 24))) {
        const Bounds bounds = scene_bounds(scene);
        extent_ = glm::distance(bounds.low, bounds.high);
        for (std::size_t k = 0; k < patches.emission.size(); ++k)
            power_ += patches.area[k / patches.bands] * patches.emission[k];
        // Powers as whole numbers, as emitters_of() wants them: 2⁵⁰ in all, so that none is lost.
        if (power_ > 0)
            emitters_ = emitters_of(scene, patches, [&](std::size_t k) {
                return std::llrint(patches.area[k / patches.bands] * patches.emission[k] / power_ *
                                   0x1p50);
            });
        for (std::uint32_t part = 0; part < parts; ++part)
            sequences_.emplace_back(mix64(settings.seed) + part);
    }

    // One part of a sensor's rays; sensors are parted by a shift of the sequence's points.
    Reading part(const Sensor& sensor, std::size_t number, std::uint32_t part) const {
        Random random(mix64(part), stream::sensors + number);
        std::array<double, Sobol::dimensions> shift;
        for (double& s : shift)
            s = random.uniform();
        // A sensor on a surface must not be hidden by it.
        const glm::dvec3 from = sensor.position + 1e-6 * extent_ * sensor.normal;
        Reading sum;
        for (std::uint32_t ray = 0; ray < rays_a_part_; ++ray) {
            auto u = sequences_[part].point(ray);
            for (std::size_t d = 0; d < u.size(); ++d)
                u[d] = std::fmod(u[d] + shift[d], 1.0);
            add_cosine_ray(from, sensor.normal, u[0], u[1], sum);
            if (!emitters_.pieces.empty())
                add_source_ray(from, sensor.normal, u[2], u[3], u[4], sum);
        }
        for (std::uint32_t band = 0; band < patches_.bands; ++band) {
            sum.irradiance[band] /= rays_a_part_;
            sum.error[band] /= rays_a_part_;
        }
        return sum;
    }

    // Lights without area: no noise.
    Bands lights(const Sensor& sensor) const {
        Bands sum{};
        const glm::dvec3 from = sensor.position + 1e-6 * extent_ * sensor.normal;
        for (const Light& light : scene_.lights) {
            const double each = light_arrives(rays_, shadow_, light, from, sensor.normal, none);
            for (std::uint32_t band = 0; band < patches_.bands; ++band)
                sum[band] += each * light.intensity[band];
        }
        return sum;
    }

private:
    // Rays by the cosine law have density cos cos' / (π r²) over the area they meet, rays to
    // sources E / power over theirs: emission is weighed by a density's share of both.
    double cosine_share(std::uint32_t patch, double cosine_density) const {
        double exitance = 0;
        for (std::uint32_t band = 0; band < patches_.bands; ++band)
            exitance += patches_.emission[std::size_t(patch) * patches_.bands + band];
        return exitance > 0 ? cosine_density / (cosine_density + exitance / power_) : 1;
    }

    void add_cosine_ray(const glm::dvec3& from, const glm::dvec3& normal, double a, double b,
                        Reading& sum) const {
        const glm::dvec3 direction = cosine_direction(normal, a, b);
        const SurfaceHit hit =
            rays_.closest(from, direction, std::numeric_limits<double>::infinity());
        if (hit.surface == none) {
            const Spectrum sky = scene_.sky.radiance(direction);
            for (std::uint32_t band = 0; band < patches_.bands; ++band)
                sum.irradiance[band] += pi * sky[band];
            return;
        }
        const std::uint32_t patch = patch_of(scene_, patches_, hit);
        if (patch == none)
            return;
        const double cosine =
            std::abs(glm::dot(direction, surface_normal(scene_, scene_.surfaces[hit.surface])));
        const double share =
            cosine_share(patch, glm::dot(normal, direction) * cosine / (pi * hit.t * hit.t));
        for (std::uint32_t band = 0; band < patches_.bands; ++band) {
            const std::size_t k = std::size_t(patch) * patches_.bands + band;
            const double emission = patches_.emission[k];
            sum.irradiance[band] += solution_.radiosity[k] - emission + share * emission;
            if (!solution_.stderror.empty())
                sum.error[band] += solution_.stderror[k];
        }
    }

    void add_source_ray(const glm::dvec3& from, const glm::dvec3& normal, double which, double a,
                        double b, Reading& sum) const {
        const std::size_t piece = emitters_.choose(which);
        const Emitter& source = emitters_.pieces[piece];
        const glm::dvec3 to = point_on(scene_, source, a, b), way = to - from;
        const double distance = glm::length(way);
        if (!(distance > 0))
            return;
        const double cosine = glm::dot(normal, way) / distance;
        const double cosine_there = -glm::dot(emitter_normal(scene_, source), way) / distance;
        if (cosine <= 0 || cosine_there <= 0 || rays_.blocked(from, to, none, source.surface))
            return;
        const double density = cosine * cosine_there / (pi * distance * distance);
        const double share = 1 - cosine_share(source.patch, density);
        double exitance = 0;
        for (std::uint32_t band = 0; band < patches_.bands; ++band)
            exitance += patches_.emission[std::size_t(source.patch) * patches_.bands + band];
        for (std::uint32_t band = 0; band < patches_.bands; ++band)
            sum.irradiance[band] +=
                share * density * power_ *
                patches_.emission[std::size_t(source.patch) * patches_.bands + band] / exitance;
    }

    const Scene& scene_;
    const Patches& patches_;
    const Solution& solution_;
    RayScene rays_;
    FarShadow shadow_{rays_, scene_};
    std::uint32_t rays_a_part_;
    double extent_ = 0, power_ = 0;
    Emitters emitters_;
    std::vector<Sobol> sequences_;
};

}  // namespace

SensorReadings sense(const Scene& scene, const Patches& patches, const Solution& solution,
                     const std::vector<Sensor>& sensors, const SensorSettings& settings) {
    const std::uint32_t bands = patches.bands;
    if (solution.bands != bands || solution.radiosity.size() != patches.count() * bands)
        throw Error(Fault::internal, "the solution is not of these patches");
    if (is_periodic(scene))
        throw Error(Fault::usage,
                    "sensors gather along rays through one tile: a periodic scene has none");
    if (!patches.specular.empty())
        throw Error(Fault::usage,
                    "sensors gather from diffuse patches alone: a scene with mirrors or glass has "
                    "none; the table of a patch in their place tells as much");
    const Gather gather(scene, patches, solution, settings);
    SensorReadings readings;
    readings.bands = bands;
    readings.irradiance.resize(sensors.size() * bands);
    readings.stderror.resize(sensors.size() * bands);
    if (!solution.stderror.empty())
        readings.solution_error.resize(sensors.size() * bands);
    parallel_for(settings.threads, sensors.size(), 1, [&](std::size_t s, std::size_t, unsigned) {
        DenormalsOff guard;
        Reading sum;
        Bands squares{};
        for (std::uint32_t part = 0; part < parts; ++part) {
            const Reading one = gather.part(sensors[s], s, part);
            for (std::uint32_t band = 0; band < bands; ++band) {
                sum.irradiance[band] += one.irradiance[band];
                squares[band] += one.irradiance[band] * one.irradiance[band];
                sum.error[band] += one.error[band];
            }
        }
        const Bands lights = gather.lights(sensors[s]);
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::size_t k = s * bands + band;
            const double mean = sum.irradiance[band] / parts;
            readings.irradiance[k] = mean + lights[band];
            readings.stderror[k] =
                std::sqrt(std::max(0.0, squares[band] / parts - mean * mean) / (parts - 1));
            if (!readings.solution_error.empty())
                readings.solution_error[k] = sum.error[band] / parts;
        }
    });
    return readings;
}

}  // namespace parallux
