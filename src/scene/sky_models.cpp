#include "scene/sky_models.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "scene/input.h"
#include "scene/textures.h"

namespace parallux {
namespace {

using Model = SkySettings::Model;

// With y up, north is -z: the default lies along the up of meshes.
void settle_north(Sky& sky) {
    if (std::abs(glm::dot(sky.north, sky.up)) > 0.999)
        sky.north = std::abs(sky.up.z) < 0.5 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
}

double mean(const Spectrum& values, std::uint32_t bands) {
    double sum = 0;
    for (std::uint32_t band = 0; band < bands; ++band)
        sum += static_cast<double>(values[band]);
    return sum / bands;
}

// Scaled so that a horizontal plane gets what was measured.
bool perez(Sky& sky, const SkySettings& settings, std::uint32_t bands) {
    const double diffuse = mean(settings.diffuse, bands);
    if (diffuse <= 0) {
        sky.kind = Sky::Kind::dark;
        return true;
    }
    sky.kind = Sky::Kind::shaped;
    sky.shape = perez_shape(sky_direction(sky, settings.elevation, settings.azimuth),
                            settings.elevation, mean(settings.direct, bands), diffuse);
    sky.zenith = Spectrum::constant(1);
    const double unit = static_cast<double>(horizontal_irradiance(sky)[0]);
    for (std::size_t band = 0; band < max_bands; ++band)
        sky.zenith[band] = static_cast<float>(static_cast<double>(settings.diffuse[band]) / unit);
    return unit > 0 && std::isfinite(unit);
}

void set_model(Sky& sky, const SkySettings& settings) {
    sky.zenith = sky.horizon = sky.ground = settings.radiance;
    if (settings.model == Model::uniform) {
        // With a ground of its own, the same from the horizon up alone.
        sky.kind = settings.has_ground ? Sky::Kind::gradient : Sky::Kind::uniform;
    } else if (settings.model == Model::overcast) {
        sky.kind = Sky::Kind::gradient;
        for (float& value : sky.horizon.value)
            value /= 3;
        sky.ground = {};
    } else {
        sky.kind = Sky::Kind::shaped;
        sky.shape = clear_shape(sky_direction(sky, settings.elevation, settings.azimuth));
        const double at_zenith = sky.shape.relative(1, std::sin(settings.elevation));
        for (float& value : sky.zenith.value)
            value = static_cast<float>(static_cast<double>(value) / at_zenith);
        sky.ground = {};
    }
}

std::optional<std::string> set_sky(Sky& sky, std::uint32_t bands, const SkySettings& settings) {
    const bool needs_sun = settings.model == Model::clear || settings.model == Model::perez;
    if (needs_sun && !settings.has_sun)
        return "this sky needs a sun with its elevation and azimuth";
    if (settings.model == Model::dark)
        return std::nullopt;
    if (settings.model == Model::image) {
        if (bands != 3)
            return "an image has three bands; give another sky per band";
        sky.kind = Sky::Kind::image;
        sky.image = decode_picture(settings.image, "", read_file(settings.image), max_texels);
        sky.image.name = printable(settings.image.string());
    } else if (settings.model == Model::perez) {
        if (!perez(sky, settings, bands))
            return "this model gives no sky for these irradiances";
    } else {
        set_model(sky, settings);
    }
    return std::nullopt;
}

// The radiance of ground that sky and sun light evenly: albedo · H / π.
void set_ground(Sky& sky, const SkySettings& settings) {
    const Spectrum from_sky = horizontal_irradiance(sky);
    const double sine = settings.has_sun ? std::sin(settings.elevation) : 0;
    for (std::size_t band = 0; band < max_bands; ++band)
        sky.ground[band] = static_cast<float>(static_cast<double>(settings.albedo[band]) / pi *
                                              (static_cast<double>(from_sky[band]) +
                                               sine * static_cast<double>(settings.direct[band])));
    if (sky.kind == Sky::Kind::dark)
        sky.kind = Sky::Kind::gradient;
}

void set_sun(Scene& scene, const SkySettings& settings) {
    std::erase_if(scene.lights, [](const Light& light) { return light.half_angle > 0; });
    if (!settings.has_sun || settings.direct == Spectrum{})
        return;
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.name = "sun";
    sun.direction = -sky_direction(scene.sky, settings.elevation, settings.azimuth);
    sun.intensity = settings.direct;
    sun.half_angle = sun_half_angle;
    scene.lights.push_back(std::move(sun));
}

}  // namespace

glm::dvec3 sky_direction(const Sky& sky, double elevation, double azimuth) {
    const glm::dvec3 east = glm::normalize(glm::cross(sky.north, sky.up));
    const glm::dvec3 north = glm::cross(sky.up, east);
    return glm::normalize(std::cos(elevation) *
                              (std::cos(azimuth) * north + std::sin(azimuth) * east) +
                          std::sin(elevation) * sky.up);
}

SkyShape clear_shape(const glm::dvec3& sun) {
    return {-1, -0.32, 10, -3, 0.45, std::exp(-3 * pi / 2), sun, 1};
}

Spectrum horizontal_irradiance(const Sky& sky) {
    // ∫ L sin h cos h dh dφ by midpoints.
    constexpr int rings = 400, round = 512;
    double sum[max_bands] = {};
    for (int ring = 0; ring < rings; ++ring) {
        const double elevation = (ring + 0.5) / rings * pi / 2;
        const double weight = std::sin(elevation) * std::cos(elevation);
        for (int k = 0; k < round; ++k) {
            const Spectrum radiance =
                sky.radiance(sky_direction(sky, elevation, 2 * pi * (k + 0.5) / round));
            for (std::size_t band = 0; band < max_bands; ++band)
                sum[band] += weight * static_cast<double>(radiance[band]);
        }
    }
    Spectrum irradiance;
    for (std::size_t band = 0; band < max_bands; ++band)
        irradiance[band] = static_cast<float>(pi * pi * sum[band] / (double(rings) * round));
    return irradiance;
}

std::optional<std::string> settle_period(Scene& scene) {
    const glm::dvec3& up = scene.sky.up;
    for (glm::dvec3& period : scene.period) {
        const double length = glm::length(period), rise = glm::dot(period, up);
        if (std::fabs(rise) > 1e-9 * length)
            return "periods must be horizontal";
        period -= rise * up;
    }
    const double first = glm::length(scene.period[0]), second = glm::length(scene.period[1]);
    if (first == 0)
        std::swap(scene.period[0], scene.period[1]);
    if (first > 0 && second > 0 &&
        glm::length(glm::cross(scene.period[0], scene.period[1])) < 1e-3 * first * second)
        return "periods must not lie along one line";
    return std::nullopt;
}

std::optional<std::string> put_sky(Scene& scene, const SkySettings& settings) {
    if (settings.model == Model::from_file && !settings.has_sun)
        return std::nullopt;
    settle_north(scene.sky);
    if (settings.model != Model::from_file) {
        Sky sky;
        sky.up = scene.sky.up;
        sky.north = scene.sky.north;
        if (auto wrong = set_sky(sky, scene.bands, settings))
            return wrong;
        if (settings.has_ground)
            set_ground(sky, settings);
        scene.sky = std::move(sky);
    }
    set_sun(scene, settings);
    return std::nullopt;
}

}  // namespace parallux
