#pragma once

#include <cstdint>
#include <memory>
#include <span>
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

/// The scene's surfaces in Embree, robust mode, about a local origin. Of surfaces in one place the
/// one that a bundle's line would meet first is met first (SharedPlaces), also where a ray leaves
/// one of them. Immutable after construction, so every query may run on any thread.
class RayScene {
public:
    /// Throws Fault::memory when Embree cannot build.
    RayScene(const Scene& scene, unsigned threads);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// The nearest crossing with t in (0, far], surface `skip`, which the ray leaves, left out (of
    /// a curved one, which may see itself, only the place that it leaves); t = 0 on what lies close
    /// before that; .surface == none: nothing.
    SurfaceHit closest(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                       std::uint32_t skip = none) const;

    /// Whether anything but the two surfaces named, on which a and b lie, is between a and b.
    bool blocked(const glm::dvec3& a, const glm::dvec3& b, std::uint32_t skip_a = none,
                 std::uint32_t skip_b = none) const;

    /// Where that line meets a curved surface (from behind: `back`) nearest to a point that lies on
    /// its facets or nearly on it, within `reach` metres; the point itself where it does not, and
    /// on planar surfaces. Of a unit direction.
    glm::dvec3 on_line(std::uint32_t surface, bool back, const glm::dvec3& point,
                       const glm::dvec3& direction, double reach) const;

    /// Whether another surface lies in front of a side of a surface at a point of it, and of a part
    /// of it, a convex polygon; `out`: the side's normal. O(1) where none shares its place.
    bool covered(std::uint32_t surface, const glm::dvec3& out, const glm::dvec3& point) const;
    bool covered_in_part(std::uint32_t surface, const glm::dvec3& out,
                         std::span<const glm::dvec3> part) const;

    /// All crossings with t in [0, far], a surface once, nearest first; ties by surface, in shared
    /// places by their order.
    void all(const glm::dvec3& origin, const glm::dvec3& direction, double far,
             std::vector<SurfaceHit>& hits) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace parallux
