#include "materials/bounce.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/directions.h"

namespace parallux {

double fresnel(double n_from, double n_to, double cosine) {
    const double sine = n_from / n_to * std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (sine >= 1)
        return 1;
    const double beyond = std::sqrt(1 - sine * sine);
    const double across = (n_from * cosine - n_to * beyond) / (n_from * cosine + n_to * beyond);
    const double along = (n_to * cosine - n_from * beyond) / (n_to * cosine + n_from * beyond);
    return 0.5 * (across * across + along * along);
}

glm::dvec3 refracted(const glm::dvec3& in, const glm::dvec3& normal, double n_from, double n_to) {
    // W. Snell: n sin θ stays.
    const double ratio = n_from / n_to, cosine = -glm::dot(in, normal);
    const double beyond = std::sqrt(std::max(0.0, 1 - ratio * ratio * (1 - cosine * cosine)));
    return glm::normalize(ratio * in + (ratio * cosine - beyond) * normal);
}

namespace {

glm::dvec3 mirrored(const glm::dvec3& in, const glm::dvec3& normal) {
    return glm::normalize(in - 2 * glm::dot(in, normal) * normal);
}

glm::dvec3 scattered(const Microfacets& rough, const glm::dvec3& in, const glm::dvec3& normal,
                     Random& random, double& along_facet) {
    glm::dvec3 x, y;
    frame_across(normal, x, y);
    const glm::dvec3 from(-glm::dot(in, x), -glm::dot(in, y),
                          std::max(1e-9, -glm::dot(in, normal)));
    const glm::dvec3 to = rough.sample(glm::normalize(from), random, along_facet);
    return glm::normalize(to.x * x + to.y * y + to.z * normal);
}

Bounce off_mirror(const Specular& mirror, const Spectrum& tint, const Microfacets* rough,
                  const glm::dvec3& in, const glm::dvec3& normal, Random& random,
                  Weights& weights) {
    double cosine = std::clamp(-glm::dot(in, normal), 0.0, 1.0);
    Bounce result;
    result.direction = rough ? scattered(*rough, in, normal, random, cosine) : mirrored(in, normal);
    // C. Schlick, An Inexpensive BRDF Model for Physically-based Rendering, 1994.
    const double grazing = std::pow(1 - cosine, 5);
    for (std::size_t band = 0; band < max_bands; ++band) {
        const double straight = tint[band];
        weights[band] *= straight + (mirror.grazing[band] - straight) * grazing;
    }
    return result;
}

Bounce at_glass(const Specular& glass, const Spectrum& tint, const glm::dvec3& in,
                const glm::dvec3& normal, bool inside, Random& random, Weights& weights) {
    const bool body = !glass.thin;
    const double n_from = inside && body ? glass.ior : 1, n_to = inside || !body ? 1 : glass.ior;
    const double cosine = std::clamp(-glm::dot(in, normal), 0.0, 1.0);
    double reflected = fresnel(n_from, body ? n_to : glass.ior, cosine);
    if (!body)  // what both faces of a sheet reflect to and fro adds up
        reflected = 2 * reflected / (1 + reflected);
    if (random.uniform() < reflected)
        return {mirrored(in, normal), false, 1};
    for (std::size_t band = 0; band < max_bands; ++band)
        weights[band] *= tint[band];
    if (!body)
        return {in, true, 1};
    const double ratio = n_from / n_to;
    return {refracted(in, normal, n_from, n_to), true, ratio * ratio};
}

}  // namespace

Bounce bounce(const Specular& specular, const Spectrum& tint, const Microfacets* rough,
              const glm::dvec3& in, const glm::dvec3& normal, bool inside, Random& random,
              Weights& weights) {
    if (specular.kind == Specular::Kind::glass)
        return at_glass(specular, tint, in, normal, inside, random, weights);
    return off_mirror(specular, tint, rough, in, normal, random, weights);
}

}  // namespace parallux
