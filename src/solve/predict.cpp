#include "parallux/predict.h"

#include <algorithm>
#include <cmath>

#include "lines/periodic.h"
#include "parallux/error.h"
#include "parallux/scatter.h"

namespace parallux {

namespace {

// Enough for the mean over all patches to be known to better than a hundredth.
constexpr std::uint64_t few_bundles = 512;

std::vector<float> irradiance(const Scene& scene, const Patches& patches,
                              const SolveSettings& settings) {
    SolveSettings quick;
    quick.bundles = few_bundles;
    quick.groups = 1;
    quick.seed = settings.seed;
    quick.threads = settings.threads;
    quick.max_memory = settings.max_memory;
    return solve(scene, patches, quick).irradiance;
}

// A sky of which (π L)² becomes π L.
Sky squared(Sky sky) {
    auto square = [](float& radiance) { radiance *= radiance * static_cast<float>(pi); };
    for (Spectrum* radiance : {&sky.zenith, &sky.horizon, &sky.ground})
        for (float& value : radiance->value)
            square(value);
    sky.shape.power *= 2;
    for (glm::vec3& texel : sky.image.texels)
        for (int k = 0; k < 3; ++k)
            square(texel[k]);
    return sky;
}

}  // namespace

double Prediction::relative(double quadratic) const {
    return mean_square > 0 ? std::sqrt(quadratic / mean_square) : 0;
}

double Prediction::lines_for(double relative_rms) const {
    return mean_square > 0 ? error_times_lines / (relative_rms * relative_rms * mean_square) : 0;
}

Prediction predict_error(const Scene& scene, const Patches& patches,
                         const SolveSettings& settings) {
    if (!patches.specular.empty())
        throw Error(Fault::usage,
                    "the theory of the error knows nothing of mirrors and glass: solve, and read "
                    "the error of the run");
    if (is_periodic(scene))
        throw Error(Fault::usage,
                    "--predict is of independent lines, which a periodic scene does not have");
    const std::size_t values = patches.reflectance.size();
    const std::vector<float> all = irradiance(scene, patches, settings);

    // What the lines will carry: the emission, or the reflected direct light of patches and lamps.
    std::vector<float> direct(values, 0);
    if (settings.first_shot != FirstShot::off || !scene.lights.empty()) {
        Scene without_sky = scene;
        without_sky.sky = {};
        Patches black = patches;
        black.reflectance.assign(values, 0);
        black.transmittance.clear();
        if (settings.first_shot == FirstShot::off)
            black.emission.assign(values, 0);
        direct = irradiance(without_sky, black, settings);
    }
    Patches moments = patches;
    for (std::size_t k = 0; k < values; ++k) {
        float rho = patches.reflectance[k];
        auto emission =
            static_cast<float>(scattered(patches, k, [&](std::size_t at) { return direct[at]; }));
        if (settings.first_shot == FirstShot::off)
            emission += patches.emission[k];
        auto reflected = static_cast<float>(
            scattered(patches, k, [&](std::size_t at) { return all[at] - direct[at]; }));
        moments.emission[k] = std::max(0.0f, emission * emission + 2 * emission * reflected);
        if (settings.direction == Direction::oriented)
            moments.emission[k] += 2 * reflected * reflected;
        moments.reflectance[k] = rho * rho;
        if (patches.translucent())
            moments.transmittance[k] = patches.transmittance[k] * patches.transmittance[k];
    }

    // The second moments spread like light.
    Scene dark = scene;
    dark.lights.clear();
    dark.sky = squared(scene.sky);
    const std::vector<float> arriving = irradiance(dark, moments, settings);
    const LineSphere sphere = line_sphere(scene, settings.sphere_radius);
    // n_j = N A_j / (2 π R²) exits of N lines, half of it oriented.
    double area_by_exit = 2 * pi * sphere.radius * sphere.radius;
    if (settings.direction == Direction::oriented)
        area_by_exit *= 2;
    Prediction prediction;
    double area = 0;
    for (std::size_t k = 0; k < values; ++k) {
        double own = patches.area[k / patches.bands];
        double radiosity =
            patches.emission[k] + scattered(patches, k, [&](std::size_t at) { return all[at]; });
        area += own;
        prediction.error_times_lines +=
            scattered(moments, k, [&](std::size_t at) { return arriving[at]; }) * area_by_exit;
        prediction.mean_square += own * radiosity * radiosity;
    }
    prediction.error_times_lines /= area;
    prediction.mean_square /= area;
    return prediction;
}

}  // namespace parallux
