#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/scene.h"

namespace parallux {

/// Where a ray meets a surface.
struct SurfaceHit {
    std::uint32_t surface = none;
    float u = 0, v = 0;  ///< on the surface's own (u, v)
    float t = 0;         ///< distance in units of the direction's length
    bool back = false;   ///< met from behind
};

/// Embree's advice: denormals off in every thread that traces, while one of these lives. Restored
/// on leaving, so that the caller's arithmetic keeps its meaning. Every query holds one; a loop of
/// many queries holds one itself, which makes theirs cheap.
class DenormalsOff {
public:
    DenormalsOff();
    ~DenormalsOff();
    DenormalsOff(const DenormalsOff&) = delete;
    DenormalsOff& operator=(const DenormalsOff&) = delete;

private:
    unsigned saved_;
    bool changed_ = false;
};

/// The scene's surfaces in Embree, robust mode, about a local origin. Immutable after
/// construction, so every query may run on any thread.
class RayScene {
public:
    /// Throws Fault::memory when Embree cannot build.
    RayScene(const Scene& scene, unsigned threads);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// The nearest crossing with t in (0, far], surface `skip` left out (a curved one,
    /// which may see itself, only next to the origin); .surface == none: nothing.
    SurfaceHit closest(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                       std::uint32_t skip = none) const;

    /// Whether anything but the two surfaces named lies between a and b.
    bool blocked(const glm::dvec3& a, const glm::dvec3& b, std::uint32_t skip_a = none,
                 std::uint32_t skip_b = none) const;

    /// All crossings with t in [0, far], nearest first, ties by surface; duplicates dropped.
    void all(const glm::dvec3& origin, const glm::dvec3& direction, double far,
             std::vector<SurfaceHit>& hits) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace parallux
