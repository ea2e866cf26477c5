#pragma once

#include <array>
#include <span>
#include <vector>

#include "factors/form_factors.h"

// What a point sees of a polygon that others hide in part, in closed form.

namespace parallux {

/// A convex cone of directions from a point, between corners that need not be of unit length.
struct Cone {
    static constexpr std::size_t max_corners = 16;

    std::array<glm::dvec3, max_corners> corners;
    std::size_t size = 0;
};

/// Memory that visible_form_factor() uses again and again; one a thread.
struct VisibleScratch {
    std::vector<Cone> seen, left;
};

/// The form factor from a small area at `point` with unit `normal` to what it sees of the front of
/// `to` past the `blockers`, which hide from both sides: what is hidden is cut away, blocker by
/// blocker, and the rest summed up by Lambert's formula. Exact but for rounding, some 1e-14; a
/// blocker seen edge on hides nothing, nor does what lies behind `to` or the point. Some 0.15 µs,
/// and as much again for each blocker in the way. (K. Weiler, P. Atherton, Hidden surface removal
/// using polygon area sorting, SIGGRAPH 1977; T. Nishita, E. Nakamae, Continuous tone
/// representation of three-dimensional objects taking account of shadows and interreflection,
/// SIGGRAPH 1985.)
double visible_form_factor(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to,
                           std::span<const Polygon> blockers, VisibleScratch& scratch);

/// All ways from one convex polygon to another: what lies outside cannot hide one from the other.
class Shaft {
public:
    /// `from` and `to` face each other, at least in part. Some 0.3 µs.
    Shaft(const Polygon& from, const Polygon& to);

    /// Whether `blocker` may hide a part of one polygon from a part of the other. Never false where
    /// it does; true where two edges pass each other closely, though it may not. Some 30 ns.
    bool holds(const Polygon& blocker) const;

private:
    struct Plane {
        glm::dvec3 origin, normal;  // unit, outward
    };

    void add_sides(const Polygon& a, const Polygon& b);
    bool outside(const Polygon& polygon, const Plane& plane) const;

    const Polygon &from_, &to_;
    double near_;                  // what is rounding, metres
    glm::dvec3 low_{0}, high_{0};  // the box of both
    std::array<Plane, 2 + 4 * Polygon::max_corners> planes_;
    std::size_t count_ = 0;
};

}  // namespace parallux
