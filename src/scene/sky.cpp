#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/texture_lookup.h"

namespace parallux {
namespace {

// Texel numbers either side of a coordinate and the weight of the second.
struct Between {
    std::uint32_t first, second;
    float weight;
};

Between between(float x, std::uint32_t size, bool repeat) {
    // Beyond 10⁷ a float has no fraction left; NaN fails the comparison, too.
    if (!(std::abs(x) < 1e7f))
        x = 0;
    auto n = static_cast<float>(size);
    float texel =
        repeat ? (x - std::floor(x)) * n - 0.5f : std::clamp(x * n - 0.5f, 0.0f, n - 1.0f);
    float below = std::floor(texel);
    auto wrapped = [&](float t) {
        auto i = static_cast<std::int64_t>(t);
        if (repeat)
            return static_cast<std::uint32_t>((i + size) % size);
        return static_cast<std::uint32_t>(std::min<std::int64_t>(i, size - 1));
    };
    return {wrapped(below), wrapped(below + 1), texel - below};
}

glm::dvec3 any_orthogonal(const glm::dvec3& d) {
    return std::abs(d.x) < 0.5 ? glm::cross(d, glm::dvec3(1, 0, 0))
                               : glm::cross(d, glm::dvec3(0, 1, 0));
}

glm::vec3 image_radiance(const Sky& sky, const glm::dvec3& direction) {
    glm::dvec3 right = glm::cross(sky.north, sky.up);
    if (glm::length(right) < 1e-9)
        right = any_orthogonal(sky.up);
    right = glm::normalize(right);
    glm::dvec3 ahead = glm::cross(sky.up, right);
    double azimuth = std::atan2(glm::dot(direction, right), glm::dot(direction, ahead));
    double polar = std::acos(std::clamp(glm::dot(direction, sky.up), -1.0, 1.0));
    return sky.scale *
           texture_at(sky.image, glm::vec2(0.5 + azimuth / (2 * pi), polar / pi), Wrap::clamp_v);
}

// The lowest of the 145 places of the sky that such shapes were fitted to stand at 6°.
constexpr double lowest_fitted = 0.104528;

double gradation(const SkyShape& s, double height) {
    return 1 + s.a * std::exp(s.b / std::max(height, s.b > 0 ? lowest_fitted : 1e-9));
}

}  // namespace

double SkyShape::relative(double height, double cos_to_sun) const {
    if (height < 0)
        return 0;
    const double cosine = std::clamp(cos_to_sun, -1.0, 1.0), angle = std::acos(cosine);
    const double indicatrix = 1 + c * (std::exp(d * angle) - offset) + e * cosine * cosine;
    const double value = std::max(0.0, gradation(*this, height)) * std::max(0.0, indicatrix);
    return power == 1 ? value : std::pow(value, power);
}

double SkyShape::bound() const {
    // Both factors are monotone, but for cos² χ.
    const double phi = std::max({0.0, gradation(*this, 0), gradation(*this, 1)});
    const double near = c * (1 - offset), far = c * (std::exp(d * pi) - offset);
    const double f = std::max(0.0, 1 + std::max(near, far) + std::max(e, 0.0));
    return std::pow(phi * f, power);
}

glm::vec3 texture_at(const Texture& t, glm::vec2 uv, Wrap wrap) {
    if (t.texels.empty())
        return glm::vec3(1);
    Between x = between(uv.x, t.width, true), y = between(uv.y, t.height, wrap == Wrap::repeat);
    auto row = [&](std::uint32_t at) {
        const glm::vec3* texels = t.texels.data() + std::size_t(at) * t.width;
        return glm::mix(texels[x.first], texels[x.second], x.weight);
    };
    return glm::mix(row(y.first), row(y.second), y.weight);
}

Spectrum Sky::radiance(const glm::dvec3& direction) const {
    Spectrum result;
    if (kind == Kind::uniform)
        return zenith;
    if (kind == Kind::gradient) {
        auto height = static_cast<float>(glm::dot(direction, up));
        if (height < 0)
            return ground;
        for (std::size_t b = 0; b < max_bands; ++b)
            result[b] = glm::mix(horizon[b], zenith[b], std::min(height, 1.0f));
    }
    if (kind == Kind::shaped) {
        const double height = glm::dot(direction, up);
        if (height < 0)
            return ground;
        const double relative = shape.relative(height, glm::dot(direction, shape.sun));
        for (std::size_t b = 0; b < max_bands; ++b)
            result[b] = static_cast<float>(relative * static_cast<double>(zenith[b]));
    }
    if (kind == Kind::image) {
        glm::vec3 seen = image_radiance(*this, direction);
        for (int b = 0; b < 3; ++b)
            result[b] = seen[b];
    }
    return result;
}

}  // namespace parallux
