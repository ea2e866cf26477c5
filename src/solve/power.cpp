#include "solve/power.h"

#include <algorithm>
#include <cmath>

namespace parallux {

double sky_bound(const Sky& sky, std::uint32_t band) {
    switch (sky.kind) {
        case Sky::Kind::dark:
            return 0;
        case Sky::Kind::uniform:
            return sky.zenith[band];
        case Sky::Kind::gradient:
            return std::max({sky.zenith[band], sky.horizon[band], sky.ground[band]});
        case Sky::Kind::shaped:
            return std::max(sky.zenith[band] * sky.shape.bound(),
                            static_cast<double>(sky.ground[band]));
        case Sky::Kind::image:
            break;
    }
    float most = 0;
    for (const glm::vec3& texel : sky.image.texels)
        most = std::max({most, texel.x, texel.y, texel.z});
    return most * sky.scale;
}

double power_bound(const Scene& scene, const Patches& patches, const LineSphere& sphere) {
    double most = 0;
    double disc = pi * sphere.radius * sphere.radius;
    double sky = 0;
    if (scene.sky.kind != Sky::Kind::dark)
        for (std::uint32_t band = 0; band < scene.bands; ++band)
            sky = std::max(sky, sky_bound(scene.sky, band) * pi * 4 * disc);
    for (std::uint32_t band = 0; band < patches.bands; ++band) {
        double watts = sky;
        for (std::size_t patch = 0; patch < patches.count(); ++patch)
            watts += patches.area[patch] * patches.emission[patch * patches.bands + band];
        for (const Light& light : scene.lights)
            watts +=
                light.intensity[band] * (light.kind == Light::Kind::directional ? disc : 4 * pi);
        most = std::max(most, watts);
    }
    return most;
}

double quantum(double power, double highest_reflectance) {
    if (power <= 0)
        return 1;
    int exponent = 0;
    std::frexp(power / (1 - highest_reflectance), &exponent);
    return std::ldexp(1.0, exponent - 60);
}

}  // namespace parallux
