#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "lines/ray_scene.h"
#include "output/interpolate.h"
#include "output/reflections.h"
#include "output/tone.h"
#include "parallel.h"
#include "parallux/error.h"
#include "parallux/picture.h"
#include "random.h"

namespace parallux {

namespace {

constexpr double filter_radius = 0.75;  // of the tent over each pixel, in pixels

struct Ray {
    glm::dvec3 origin, direction;
};

// Turns places on the picture, in pixels from its upper left corner, into rays.
class View {
public:
    View(const Camera& camera, std::uint32_t width, std::uint32_t height) : camera_(camera) {
        right_ = glm::normalize(glm::cross(camera.forward, camera.up));
        up_ = glm::cross(right_, camera.forward);
        bool parallel = camera.orthographic_height > 0;
        half_height_ =
            parallel ? 0.5 * camera.orthographic_height : std::tan(0.5 * camera.vertical_fov);
        middle_x_ = 0.5 * width, middle_y_ = 0.5 * height;
    }

    Ray ray(double x, double y) const {
        glm::dvec3 aside =
            half_height_ / middle_y_ * ((x - middle_x_) * right_ + (middle_y_ - y) * up_);
        if (camera_.orthographic_height > 0)
            return {camera_.position + aside, camera_.forward};
        return {camera_.position, glm::normalize(camera_.forward + aside)};
    }

private:
    const Camera& camera_;
    glm::dvec3 right_, up_;
    double half_height_, middle_x_, middle_y_;
};

// What one ray sees.
struct Sight {
    std::uint32_t patch = none;
    glm::dvec3 normal{0};
    Spectrum radiance, irradiance, albedo;
};

// Sums over a pixel's samples, divided at the end.
struct PixelSums {
    Spectrum radiance, display, irradiance, albedo, stderror;
    glm::dvec3 normal{0};
    double met = 0, display_weight = 0;
};

// L = B / π per band: B = E + ρ H and what comes through.
Spectrum radiance_of(const Spectrum& emission, const Spectrum& reflectance,
                     const Spectrum& irradiance, const Spectrum& through) {
    Spectrum radiance;
    for (std::size_t b = 0; b < max_bands; ++b)
        radiance[b] =
            static_cast<float>((emission[b] + reflectance[b] * irradiance[b] + through[b]) / pi);
    return radiance;
}

class Renderer {
public:
    Renderer(const Scene& scene, const Patches& patches, const Solution& solution,
             const PictureSettings& settings)
        : scene_(scene),
          patches_(patches),
          solution_(solution),
          settings_(settings),
          rays_(scene, settings.threads),
          field_(scene, patches, solution, rays_, settings.threads),
          reflections_(scene, patches, rays_),
          glare_(0.18 * std::exp2(settings.exposure) / usual_luminance(patches, solution)) {}

    // Fills one pixel of every layer.
    void pixel(const View& view, std::uint32_t x, std::uint32_t y, Picture& picture) const {
        std::uint32_t samples = std::max(1u, settings_.samples);
        Random random(0x70697865, std::uint64_t(y) << 32 | x);
        double shift_x = random.uniform(), shift_y = random.uniform();
        PixelSums sums;
        for (std::uint32_t i = 0; i < samples; ++i) {
            // Place the samples on a Fibonacci lattice, shifted by pixel and bent to a tent.
            double dx = tent(std::fmod((i + 0.5) / samples + shift_x, 1.0));
            double dy = tent(std::fmod(i * 0.6180339887498949 + shift_y, 1.0));
            add(sums, look(view.ray(x + 0.5 + dx, y + 0.5 + dy), random));
        }
        store(sums, samples, std::size_t(y) * picture.width + x, picture);
        picture.patch[std::size_t(y) * picture.width + x] =
            patch_id(look(view.ray(x + 0.5, y + 0.5), random));
    }

private:
    static double tent(double u) {
        double t = u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
        return filter_radius * t;
    }

    static float patch_id(const Sight& sight) {
        return sight.patch == none ? -1.0f : static_cast<float>(sight.patch);
    }

    bool seen(const SurfaceHit& hit) const {
        return !hit.back || patches_.grids[hit.surface].back != none;
    }

    // The first surface along a ray that shows itself; backs of one-sided ones are seen through.
    SurfaceHit meet(const Ray& ray) const {
        SurfaceHit hit = rays_.closest(ray.origin, ray.direction, HUGE_VAL);
        if (hit.surface == none || seen(hit))
            return hit;
        thread_local std::vector<SurfaceHit> hits;
        rays_.all(ray.origin, ray.direction, HUGE_VAL, hits);
        for (const SurfaceHit& next : hits)
            if (seen(next))
                return next;
        return {};
    }

    Sight look(const Ray& ray, Random& random) const {
        Sight sight;
        SurfaceHit hit = meet(ray);
        if (hit.surface == none) {
            if (scene_.sky.kind != Sky::Kind::dark)
                sight.radiance = scene_.sky.radiance(ray.direction);
            return sight;
        }
        const Surface& surface = scene_.surfaces[hit.surface];
        const SurfaceGrid& grid = patches_.grids[hit.surface];
        sight = of_patches(hit, (hit.back ? grid.back : grid.front) +
                                    cell_at(surface.shape(), grid.nu, grid.nv, hit.u, hit.v));
        if (patches_.specular_share(sight.patch) > 0)
            reflections_.add(
                ray.direction, hit,
                [&](const SurfaceHit& seen, std::uint32_t patch) {
                    return of_patches(seen, patch).radiance;
                },
                random, sight.radiance);
        return sight;
    }

    // What the patches themselves show.
    Sight of_patches(const SurfaceHit& hit, std::uint32_t patch) const {
        Sight sight;
        const Surface& surface = scene_.surfaces[hit.surface];
        sight.patch = patch;
        sight.normal = surface_normal(scene_, surface) * (hit.back ? -1.0 : 1.0);
        sight.albedo = surface_reflectance(scene_, hit.surface, hit.u, hit.v, hit.back);
        const std::uint32_t bands = solution_.bands;
        if (settings_.flat) {
            for (std::uint32_t b = 0; b < bands; ++b) {
                std::size_t at = std::size_t(sight.patch) * bands + b;
                sight.irradiance[b] = solution_.irradiance[at];
                sight.radiance[b] = static_cast<float>(solution_.radiosity[at] / pi);
            }
            return sight;
        }
        field_.at(hit.surface, hit.back, hit.u, hit.v, sight.irradiance.value.data());
        sight.radiance = radiance_of(surface_emission(scene_, hit.surface, hit.u, hit.v),
                                     sight.albedo, sight.irradiance,
                                     field_.coming_through(hit.surface, hit.back, hit.u, hit.v));
        return sight;
    }

    void add(PixelSums& sums, const Sight& sight) const {
        double bright = luminance(sight.radiance.value.data(), solution_.bands);
        double weight = 1 / (1 + std::max(bright, 0.0) * glare_);
        sums.display_weight += weight;
        sums.met += sight.patch != none ? 1 : 0;
        sums.normal += sight.normal;
        for (std::uint32_t b = 0; b < solution_.bands; ++b) {
            sums.radiance[b] += sight.radiance[b];
            sums.display[b] += static_cast<float>(weight * sight.radiance[b]);
            sums.irradiance[b] += sight.irradiance[b];
            sums.albedo[b] += sight.patch != none ? sight.albedo[b] : 0;
            if (!solution_.stderror.empty() && sight.patch != none)
                sums.stderror[b] +=
                    solution_.stderror[std::size_t(sight.patch) * solution_.bands + b];
        }
    }

    void store(const PixelSums& sums, std::uint32_t samples, std::size_t i, Picture& to) const {
        double share = 1.0 / samples;
        for (std::uint32_t b = 0; b < solution_.bands; ++b) {
            std::size_t at = i * solution_.bands + b;
            to.radiance[at] = static_cast<float>(share * sums.radiance[b]);
            to.display[at] = static_cast<float>(sums.display[b] / sums.display_weight);
            to.irradiance[at] = static_cast<float>(share * sums.irradiance[b]);
            to.albedo[at] = static_cast<float>(share * sums.albedo[b]);
            if (!to.stderror.empty())
                to.stderror[at] = static_cast<float>(share * sums.stderror[b]);
            if (!std::isfinite(to.radiance[at]) || !std::isfinite(to.display[at]))
                throw Error(Fault::internal, "pixel " + std::to_string(i % to.width) + "," +
                                                 std::to_string(i / to.width) +
                                                 " has no finite radiance");
        }
        to.alpha[i] = static_cast<float>(share * sums.met);
        for (int axis = 0; axis < 3; ++axis)
            to.normal[3 * i + axis] = static_cast<float>(share * sums.normal[axis]);
    }

    const Scene& scene_;
    const Patches& patches_;
    const Solution& solution_;
    const PictureSettings& settings_;
    RayScene rays_;
    Interpolation field_;
    Reflections reflections_;
    double glare_;
};

Picture blank(const Solution& solution, const Camera& camera, const PictureSettings& settings) {
    Picture picture;
    picture.width = settings.width;
    picture.height = settings.height;
    if (picture.height == 0) {
        double aspect = camera.aspect > 0 ? camera.aspect : 1;
        double height = std::clamp(std::round(settings.width / aspect), 1.0, 65536.0);
        picture.height = static_cast<std::uint32_t>(height);
    }
    if (picture.width == 0 || picture.width > 65536 || picture.height > 65536)
        throw Error(Fault::usage, "a picture is 1 to 65536 pixels wide and high");
    picture.bands = solution.bands;
    std::size_t pixels = std::size_t(picture.width) * picture.height;
    for (std::vector<float>* layer :
         {&picture.radiance, &picture.display, &picture.irradiance, &picture.albedo})
        layer->resize(pixels * picture.bands);
    if (!solution.stderror.empty())
        picture.stderror.resize(pixels * picture.bands);
    picture.alpha.resize(pixels);
    picture.normal.resize(3 * pixels);
    picture.patch.resize(pixels);
    return picture;
}

}  // namespace

Picture render(const Scene& scene, const Patches& patches, const Solution& solution,
               const Camera& camera, const PictureSettings& settings) {
    Picture picture = blank(solution, camera, settings);
    Renderer renderer(scene, patches, solution, settings);
    View view(camera, picture.width, picture.height);
    // Take small runs of pixels, so that every thread stays busy to the end.
    std::size_t pixels = picture.alpha.size();
    parallel_for(settings.threads, pixels, 256, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            renderer.pixel(view, static_cast<std::uint32_t>(i % picture.width),
                           static_cast<std::uint32_t>(i / picture.width), picture);
    });
    return picture;
}

}  // namespace parallux
