#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "materials/microfacets.h"
#include "parallux/scene.h"

// What mirrors and glass do with light, here and nowhere else.

namespace parallux {

/// A factor a band.
using Weights = std::array<double, max_bands>;

/// How light that met a surface goes on.
struct Bounce {
    glm::dvec3 direction{0};  ///< unit
    bool through = false;     ///< leaves from the other side
    /// What radiance seen against the direction is multiplied by beside the weights, since glass
    /// gathers light in a narrower cone: (n before / n after)². Power is not.
    double radiance = 1;
};

/// Share of unpolarised light that a smooth surface reflects, from index n_from to n_to, `cosine`
/// of incidence 0 … 1. 1: total reflection (A. Fresnel, 1823).
double fresnel(double n_from, double n_to, double cosine);

/// The direction in which `in` is refracted at a surface with this normal on its side, both unit;
/// only where fresnel() is below 1.
glm::dvec3 refracted(const glm::dvec3& in, const glm::dvec3& normal, double n_from, double n_to);

/// One way for light that travels along unit `in` and meets the specular part of a surface, whose
/// unit normal on that side is `normal`; `inside`: comes out of a body of glass. Chosen so that the
/// mean over the ways, times `weights`, which are multiplied, is what it does. `tint`: its colour
/// there. `rough`: null where it is smooth. Reciprocal, so that it tells as well what is seen.
Bounce bounce(const Specular& specular, const Spectrum& tint, const Microfacets* rough,
              const glm::dvec3& in, const glm::dvec3& normal, bool inside, Random& random,
              Weights& weights);

}  // namespace parallux
