#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <glm/geometric.hpp>

#include "lines/ray_scene.h"
#include "parallel.h"
#include "random.h"
#include "reference/evaluated_roughness.h"
#include "solve/emitters.h"

// J. T. Kajiya, The Rendering Equation, 1986.

namespace parallux {

namespace {

using Bands = std::array<double, max_bands>;
using glm::dot;
using glm::dvec3;

// Any direction of the hemisphere about a normal, by the cosine.
dvec3 over_hemisphere(const dvec3& normal, Random& random) {
    // A uniform point of the unit sphere about the normal's end.
    const double z = 2 * random.uniform() - 1, angle = 2 * pi * random.uniform();
    const double r = std::sqrt(1 - z * z);
    const dvec3 sum = normal + dvec3(r * std::cos(angle), r * std::sin(angle), z);
    const double length = glm::length(sum);
    return length > 1e-9 ? sum / length : normal;
}

class Tracer {
public:
    Tracer(const Scene& scene, const Patches& patches, unsigned threads)
        : scene_(scene), patches_(patches), cells_(scene, patches), rays_(scene, threads) {
        for (const Material& material : scene.materials) {
            const double r = material.specular.roughness;
            rough_.push_back(r > 0 && material.specular.kind == Specular::Kind::mirror
                                 ? std::make_unique<EvaluatedRoughness>(r * r)
                                 : nullptr);
        }
    }

    // From anywhere on a patch, by the cosine.
    void leave(std::uint32_t patch, dvec3& from, dvec3& direction, std::uint32_t& skip,
               Random& random) const {
        const Emitter& cell = cells_.choose(patch, random.uniform());
        const double a = random.uniform(), b = random.uniform();
        from = point_on(scene_, cell, a, b);
        direction = over_hemisphere(emitter_normal(scene_, cell), random);
        skip = cell.surface;
    }

    // What is seen from a point, which lies inside glass where the next thing met is its back.
    Bands radiance(dvec3 from, dvec3 direction, std::uint32_t skip, Random& random) const {
        Bands seen{}, weight{};
        weight.fill(1);
        const Material* within = nullptr;
        for (int length = 0; length < 100'000; ++length) {
            const SurfaceHit hit =
                rays_.closest(from, direction, std::numeric_limits<double>::infinity(), skip);
            if (hit.surface == none) {
                add_sky(direction, weight, seen);
                return seen;
            }
            const Surface& surface = scene_.surfaces[hit.surface];
            const Material& material = scene_.materials[surface.material];
            const Specular& shine = material.specular;
            const bool body = shine.kind == Specular::Kind::glass && !shine.thin;
            if (hit.back && body)
                within = &material;
            for (std::uint32_t b = 0; within && b < scene_.bands; ++b)
                weight[b] *= std::exp(-within->specular.absorption[b] * hit.t);
            if (hit.back && !material.two_sided)
                return seen;
            const Spectrum emission = surface_emission(scene_, hit.surface, hit.u, hit.v);
            for (std::uint32_t b = 0; b < scene_.bands; ++b)
                seen[b] += weight[b] * emission[b] / pi;
            dvec3 normal = surface_normal(scene_, surface);
            if (hit.back)
                normal = -normal;
            from = surface_point(scene_, surface, hit.u, hit.v);
            skip = hit.surface;
            const double share = material.specular_share();
            // Either part by equal chances, where there are both.
            const bool both = share > 0 && share < 1;
            const bool shines = share == 1 || (both && random.uniform() < 0.5);
            const double part = (shines ? share : 1) * (both ? 2 : 1);
            if (!shines) {
                // What the diffuse part gets, as little of it as meets it, leaves by the cosine.
                diffuse(hit, part * (1 - share), from, direction, skip, weight, random);
            } else if (shine.kind == Specular::Kind::mirror) {
                mirror(hit, shine, part, normal, direction, weight, random);
            } else {
                const bool inside =
                    glass(hit, shine, part, body, normal, direction, weight, random);
                if (body)
                    within = inside ? &material : nullptr;
            }
            if (!survives(weight, random))
                return seen;
        }
        return seen;
    }

private:
    // Russian roulette, once little is left.
    bool survives(Bands& weight, Random& random) const {
        const double most = *std::max_element(weight.begin(), weight.begin() + scene_.bands);
        if (most <= 0)
            return false;
        if (most >= 0.25)
            return true;
        if (random.uniform() >= most)
            return false;
        for (double& w : weight)
            w /= most;
        return true;
    }

    void add_sky(const dvec3& direction, const Bands& weight, Bands& seen) const {
        const Spectrum sky = scene_.sky.radiance(direction);
        for (std::uint32_t b = 0; b < scene_.bands; ++b)
            seen[b] += weight[b] * (scene_.sky.kind == Sky::Kind::dark ? 0 : sky[b]);
        for (const Light& sun : scene_.lights) {
            const double sine = std::sin(sun.half_angle);
            if (sun.half_angle > 0 && dot(-sun.direction, direction) > std::cos(sun.half_angle))
                for (std::uint32_t b = 0; b < scene_.bands; ++b)
                    seen[b] += weight[b] * sun.intensity[b] / (pi * sine * sine);
        }
    }

    // A patch sends the same from everywhere: the path goes on from anywhere on it.
    void diffuse(const SurfaceHit& hit, double part, dvec3& from, dvec3& direction,
                 std::uint32_t& skip, Bands& weight, Random& random) const {
        const SurfaceGrid& grid = patches_.grids[hit.surface];
        const std::uint32_t patch =
            (hit.back ? grid.back : grid.front) +
            cell_at(scene_.surfaces[hit.surface].shape(), grid.nu, grid.nv, hit.u, hit.v);
        const std::uint32_t other = patches_.translucent() ? patches_.other[patch] : none;
        // Light comes from this side, or from the other one.
        const bool across = other != none && random.uniform() < 0.5;
        for (std::uint32_t b = 0; b < scene_.bands; ++b)
            weight[b] *= part * (other != none ? 2 : 1) *
                         (across ? patches_.transmittance[other * patches_.bands + b]
                                 : patches_.reflectance[patch * patches_.bands + b]);
        leave(across ? other : patch, from, direction, skip, random);
    }

    void mirror(const SurfaceHit& hit, const Specular& shine, double part, const dvec3& normal,
                dvec3& direction, Bands& weight, Random& random) const {
        const Spectrum tint = surface_tint(scene_, hit.surface, hit.u, hit.v);
        const dvec3 back = -direction;
        double facets = 1, between = 0, cosine = dot(normal, back);
        if (shine.roughness > 0) {
            const EvaluatedRoughness& rough = *rough_[scene_.surfaces[hit.surface].material];
            direction = over_hemisphere(normal, random);
            facets = rough.facets(normal, back, direction);
            between = rough.between(dot(normal, back), dot(normal, direction));
            cosine = dot(glm::normalize(back + direction), back);
        } else {
            direction += 2 * cosine * normal;
        }
        auto schlick = [&](std::uint32_t b, double c) {
            return tint[b] + (shine.grazing[b] - tint[b]) * std::pow(1 - c, 5.0);
        };
        for (std::uint32_t b = 0; b < scene_.bands; ++b)
            weight[b] *=
                part * (facets * schlick(b, cosine) + between * schlick(b, std::sqrt(0.5)));
    }

    // Fresnel by the angles, sin and tan. Whether the path goes on inside.
    bool glass(const SurfaceHit& hit, const Specular& shine, double part, bool body,
               const dvec3& normal, dvec3& direction, Bands& weight, Random& random) const {
        const bool out = hit.back && body;
        const double n = out ? 1 / shine.ior : shine.ior;
        const double a = std::acos(std::clamp(-dot(normal, direction), 0.0, 1.0));
        double reflected = 1, b = 0;
        if (std::sin(a) < n) {
            b = std::asin(std::sin(a) / n);
            if (a < 1e-4)
                reflected = std::pow((n - 1) / (n + 1), 2);
            else
                reflected = 0.5 * (std::pow(std::sin(a - b) / std::sin(a + b), 2) +
                                   std::pow(std::tan(a - b) / std::tan(a + b), 2));
        }
        if (!body)
            reflected = 2 * reflected / (1 + reflected);
        // Reflected or not by equal chances, and weighted.
        const bool back = reflected >= 1 || random.uniform() < 0.5;
        const double chance = reflected >= 1 ? 1 : 0.5;
        const Spectrum tint = surface_tint(scene_, hit.surface, hit.u, hit.v);
        // Radiance over n² stays.
        const double narrower = body ? 1 / (n * n) : 1;
        for (std::uint32_t band = 0; band < scene_.bands; ++band)
            weight[band] *=
                part / chance * (back ? reflected : (1 - reflected) * tint[band] * narrower);
        if (back) {
            direction += 2 * std::cos(a) * normal;
        } else if (body) {
            const dvec3 along = direction + std::cos(a) * normal;
            direction = glm::normalize(along / n - std::cos(b) * normal);
        }
        direction = glm::normalize(direction);
        return back == out;
    }

    const Scene& scene_;
    const Patches& patches_;
    PatchCells cells_;
    RayScene rays_;
    std::vector<std::unique_ptr<EvaluatedRoughness>> rough_;  // a material
};

// Mean and error of paths in slabs, the same on any number of threads.
template <class Path>
PathEstimate estimate(std::uint64_t paths, std::uint32_t bands, double scale, Path&& path) {
    Bands sum{}, squares{};
    for (std::uint64_t k = 0; k < paths; ++k) {
        const Bands one = path();
        for (std::uint32_t b = 0; b < bands; ++b) {
            sum[b] += one[b];
            squares[b] += one[b] * one[b];
        }
    }
    PathEstimate result;
    const double n = static_cast<double>(paths);
    for (std::uint32_t b = 0; b < bands; ++b) {
        result.mean[b] = scale * sum[b] / n;
        result.error[b] =
            scale * std::sqrt(std::max(0.0, squares[b] / n - sum[b] / n * sum[b] / n) / (n - 1));
    }
    return result;
}

}  // namespace

std::vector<PathEstimate> traced_irradiance(const Scene& scene, const Patches& patches,
                                            const PathSettings& settings) {
    const Tracer tracer(scene, patches, settings.threads);
    std::vector<PathEstimate> result(patches.count());
    parallel_for(
        settings.threads, patches.count(), 1, [&](std::size_t patch, std::size_t, unsigned) {
            const double diffuse = 1 - patches.specular_share(patch);
            if (diffuse <= 0)
                return;
            DenormalsOff guard;
            Random random(settings.seed, stream::path_tracer + patch);
            result[patch] = estimate(settings.paths, patches.bands, pi * diffuse, [&] {
                dvec3 from, direction;
                std::uint32_t skip = none;
                tracer.leave(static_cast<std::uint32_t>(patch), from, direction, skip, random);
                return tracer.radiance(from, direction, skip, random);
            });
        });
    return result;
}

PathEstimate traced_radiance(const Scene& scene, const Patches& patches, const glm::dvec3& from,
                             const glm::dvec3& direction, const PathSettings& settings) {
    const Tracer tracer(scene, patches, settings.threads);
    DenormalsOff guard;
    Random random(settings.seed, stream::path_tracer);
    return estimate(settings.paths, scene.bands, 1,
                    [&] { return tracer.radiance(from, direction, none, random); });
}

}  // namespace parallux
