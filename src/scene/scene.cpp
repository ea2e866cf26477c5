#include "parallux/scene.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/loaders.h"
#include "scene/texture_lookup.h"

namespace parallux {
namespace {

struct Frame {
    glm::dvec3 origin, u, v;
};

Frame frame_of(const Scene& scene, const Surface& s) {
    glm::dvec3 origin = scene.positions[s.corner[0]];
    return {origin, scene.positions[s.corner[1]] - origin, scene.positions[s.corner_v()] - origin};
}

template <class T>
T affine_at(const std::array<T, 3>& values, double u, double v) {
    return values[0] + static_cast<float>(u) * (values[1] - values[0]) +
           static_cast<float>(v) * (values[2] - values[0]);
}

// Three channels apply to scenes of three bands only.
void multiply(const Scene& scene, Spectrum& spectrum, const glm::vec3& colour) {
    if (scene.bands != 3)
        return;
    for (int band = 0; band < 3; ++band)
        spectrum[band] *= colour[band];
}

void multiply_texture(const Scene& scene, Spectrum& spectrum, std::uint32_t texture,
                      std::uint32_t uv_set, std::uint32_t surface, double u, double v) {
    if (texture == none)
        return;
    glm::vec2 uv(0);
    if (!scene.attributes.empty()) {
        const SurfaceAttributes& a = scene.attributes[surface];
        uv = affine_at(uv_set == 0 ? a.uv0 : a.uv1, u, v);
    }
    multiply(scene, spectrum, texture_at(scene.textures[texture], uv, Wrap::repeat));
}

}  // namespace

glm::dvec3 surface_point(const Scene& scene, const Surface& surface, double u, double v) {
    Frame f = frame_of(scene, surface);
    return f.origin + u * f.u + v * f.v;
}

glm::dvec3 surface_normal(const Scene& scene, const Surface& surface) {
    Frame f = frame_of(scene, surface);
    // Unit edges first: the cross product of tiny or huge ones could leave the range of a double.
    return glm::normalize(glm::cross(glm::normalize(f.u), glm::normalize(f.v)));
}

double surface_area(const Scene& scene, const Surface& surface) {
    Frame f = frame_of(scene, surface);
    double area = glm::length(glm::cross(f.u, f.v));
    return surface.shape() == Shape::triangle ? area / 2 : area;
}

bool Material::is_translucent() const {
    return transmittance != Spectrum{} || transmittance_of(true) != Spectrum{};
}

Spectrum surface_reflectance(const Scene& scene, std::uint32_t surface, double u, double v,
                             bool back) {
    const Material& m = scene.materials[scene.surfaces[surface].material];
    Spectrum rho = back && m.own_back ? m.back_reflectance : m.reflectance;
    const Spectrum& tau = m.transmittance_of(back);
    multiply_texture(scene, rho, m.reflectance_texture, m.reflectance_uv, surface, u, v);
    if (!scene.attributes.empty())
        multiply(scene, rho, affine_at(scene.attributes[surface].colour, u, v));
    for (std::size_t band = 0; band < max_bands; ++band)
        rho[band] = std::max(0.0f, std::min(rho[band], 0.999f - tau[band]));
    return rho;
}

Spectrum surface_tint(const Scene& scene, std::uint32_t surface, double u, double v) {
    const Material& m = scene.materials[scene.surfaces[surface].material];
    Spectrum tint = m.specular.colour;
    multiply_texture(scene, tint, m.reflectance_texture, m.reflectance_uv, surface, u, v);
    if (!scene.attributes.empty())
        multiply(scene, tint, affine_at(scene.attributes[surface].colour, u, v));
    for (float& value : tint.value)
        value = std::clamp(value, 0.0f, 1.0f);
    return tint;
}

bool is_specular(const Scene& scene) {
    return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& s) {
        return scene.materials[s.material].specular_share() > 0;
    });
}

std::string side_fault(const Material& m) {
    if ((m.own_back || m.is_translucent()) && !m.two_sided)
        return "only what is two-sided has a back or lets light through";
    for (bool back : {false, true}) {
        const Spectrum& rho = back && m.own_back ? m.back_reflectance : m.reflectance;
        for (std::size_t band = 0; band < max_bands; ++band)
            if (!(rho[band] + m.transmittance_of(back)[band] < 1))
                return std::string(back ? "back: " : "") +
                       "reflectance and transmittance must be less than 1 together: light would "
                       "never end";
    }
    return {};
}

Spectrum surface_emission(const Scene& scene, std::uint32_t surface, double u, double v) {
    const Material& m = scene.materials[scene.surfaces[surface].material];
    Spectrum emission = m.emission;
    multiply_texture(scene, emission, m.emission_texture, m.emission_uv, surface, u, v);
    return emission;
}

Bounds scene_bounds(const Scene& scene) {
    if (scene.surfaces.empty())
        return {};
    glm::dvec3 first = scene.positions[scene.surfaces[0].corner[0]];
    Bounds bounds{first, first};
    for (const Surface& s : scene.surfaces)
        for (std::uint32_t c : s.corner)
            if (c != none) {
                bounds.low = glm::min(bounds.low, scene.positions[c]);
                bounds.high = glm::max(bounds.high, scene.positions[c]);
            }
    return bounds;
}

bool is_closed(const Scene& scene) {
    std::vector<std::uint64_t> edges;
    edges.reserve(4 * scene.surfaces.size());
    for (const Surface& s : scene.surfaces) {
        std::size_t n = s.shape() == Shape::triangle ? 3 : 4;
        for (std::size_t k = 0; k < n; ++k) {
            auto [low, high] = std::minmax(s.corner[k], s.corner[(k + 1) % n]);
            edges.push_back(std::uint64_t(low) << 32 | high);
        }
    }
    std::sort(edges.begin(), edges.end());
    // An edge that occurs an odd number of times breaks a pairing of neighbours.
    for (std::size_t i = 0; i < edges.size(); i += 2)
        if (i + 1 == edges.size() || edges[i] != edges[i + 1])
            return false;
    return !edges.empty();
}

}  // namespace parallux
