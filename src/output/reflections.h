#pragma once

#include <functional>

#include "materials/walk.h"

namespace parallux {

/// What pictures show of mirrors and glass. Any number of threads may ask at once.
class Reflections {
public:
    /// What a patch sends by itself from a place of it.
    using Radiance = std::function<Spectrum(const SurfaceHit& hit, std::uint32_t patch)>;

    /// Keeps references to all.
    Reflections(const Scene& scene, const Patches& patches, const RayScene& rays)
        : walks_(scene, patches, rays) {}

    /// Adds what the specular part of what a ray along a unit direction has met shows: patches by
    /// `of_patch`, and the sky. Sight is followed as walks of light are, 8 times, and 32 times off
    /// rough mirrors, which may meet a lamp or not.
    void add(const glm::dvec3& direction, const SurfaceHit& hit, const Radiance& of_patch,
             Random& random, Spectrum& radiance) const;

private:
    bool is_dark(std::uint32_t patch) const;

    Walks walks_;
};

}  // namespace parallux
