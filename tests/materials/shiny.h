#pragma once

#include <utility>

#include "parallux/solve.h"
#include "support/hand_made.h"

// Materials and scenes that mirror, or are of glass.

namespace parallux::test {

/// Reflects alike at all angles. `base`: reflectance of the diffuse part, where there is one.
inline Material mirror(double reflectance, double roughness = 0, double share = 1,
                       double base = 0) {
    Material material = grey(base, 0, true);
    material.name = "mirror";
    material.specular.kind = Specular::Kind::mirror;
    material.specular.share = static_cast<float>(share);
    material.specular.colour = Spectrum::constant(static_cast<float>(reflectance));
    material.specular.grazing = material.specular.colour;
    material.specular.roughness = static_cast<float>(roughness);
    return material;
}

inline Material glass(double ior, double absorption = 0, bool thin = false) {
    Material material = grey(0, 0, true);
    material.name = "glass";
    material.specular.kind = Specular::Kind::glass;
    material.specular.colour = Spectrum::constant(1);
    material.specular.ior = ior;
    material.specular.absorption = Spectrum::constant(static_cast<float>(absorption));
    material.specular.thin = thin;
    return material;
}

inline Material emitting(Material material, double emission) {
    material.emission = Spectrum::constant(static_cast<float>(emission));
    return material;
}

/// Adds a parallelogram of a material of its own, n × n cells.
inline void add_plate(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u,
                      const glm::dvec3& v, const Material& material, std::uint16_t n = 1) {
    add_quad(scene, origin, u, v);
    Surface& surface = scene.surfaces.back();
    surface.material = static_cast<std::uint32_t>(scene.materials.size());
    surface.grid_u = surface.grid_v = n;
    scene.materials.push_back(material);
    if (scene.objects.empty())
        scene.objects.push_back("plates");
}

/// Adds a whole sphere, itself and not facets, with nu × nv cells.
inline void add_sphere(Scene& scene, const glm::dvec3& centre, double radius,
                       const Material& material, std::uint16_t nu, std::uint16_t nv,
                       bool inward = false) {
    Curve curve;
    curve.profile = Curve::Profile::arc;
    curve.point[0] = {0, 0, 0};
    curve.point[1] = {1, 0, 0};
    curve.point[2] = {0, 1, 0};
    curve.origin = centre;
    curve.radius = radius;
    curve.start = -pi / 2;
    curve.end = pi / 2;
    if (!inward)
        std::swap(curve.low.y, curve.high.y);
    Surface surface;
    surface.corner.fill(static_cast<std::uint32_t>(scene.positions.size()));
    surface.curve = static_cast<std::uint32_t>(scene.curves.size());
    surface.material = static_cast<std::uint32_t>(scene.materials.size());
    surface.grid_u = nu;
    surface.grid_v = nv;
    scene.positions.push_back(centre - radius * glm::dvec3(0, 0, 1));
    scene.curves.push_back(curve);
    scene.surfaces.push_back(surface);
    scene.materials.push_back(material);
    if (scene.objects.empty())
        scene.objects.push_back("spheres");
}

/// Adds an upright box of one material, faces outward, n × n cells a face.
inline void add_block(Scene& scene, const glm::dvec3& low, const glm::dvec3& high,
                      const Material& material, std::uint32_t n = 1) {
    const auto m = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    add_box(scene, [&](glm::dvec3 p) { return low + p * (high - low); }, false, n,
            {m, m, m, m, m, m});
}

}  // namespace parallux::test
