#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

#include <glm/vec3.hpp>

// Diffuse form factors between planar polygons with nothing in between, in closed form.

namespace parallux {

/// A convex planar polygon in metres, its corners counter-clockwise seen from the side it faces.
/// Holds up to 7 corners; more is Fault::internal. No memory is taken.
class Polygon {
public:
    static constexpr std::size_t max_corners = 7;

    Polygon() = default;
    Polygon(std::initializer_list<glm::dvec3> corners);

    /// Appends a corner.
    void add(const glm::dvec3& corner);

    std::size_t size() const { return size_; }
    const glm::dvec3& operator[](std::size_t k) const { return corners_[k]; }
    /// The corner that follows corner k, the first after the last.
    const glm::dvec3& next(std::size_t k) const { return corners_[k + 1 == size_ ? 0 : k + 1]; }
    const glm::dvec3* begin() const { return corners_.data(); }
    const glm::dvec3* end() const { return corners_.data() + size_; }

private:
    friend Polygon in_front_of(const Polygon&, const glm::dvec3&, const glm::dvec3&);

    void append(const glm::dvec3& corner, std::size_t limit);

    std::array<glm::dvec3, max_corners + 1> corners_{};  // one more: a cut by a plane adds one
    std::size_t size_ = 0;
};

/// Area times unit normal, m²; zero for fewer than three corners.
glm::dvec3 area_vector(const Polygon& polygon);
/// Area, m².
double area(const Polygon& polygon);
/// Unit normal of the side it faces; zero where there is no area.
glm::dvec3 unit_normal(const Polygon& polygon);
/// The part of `polygon` on the side of the plane through `origin` that the unit `normal` points
/// to, without corners where there is none. Distances from the plane below 1e-12 of the
/// polygon's size count as zero (I. Sutherland, G. Hodgman, Reentrant polygon clipping, CACM
/// 17(1), 1974).
Polygon in_front_of(const Polygon& polygon, const glm::dvec3& origin, const glm::dvec3& normal);

/// The exchange area A_a F_ab = A_b F_ba in m²: ∬ cosθ cosθ' / (π r²) over both polygons, where
/// each sees the other's front. Any position: what lies behind the other's plane takes no part,
/// polygons may share corners, edges or parts of them, and cut through each other. 0 when they do
/// not face each other, share a plane or have no area. The error is below 1e-9 of the value, but
/// for rounding: up to some 1e-14 of their joint extent squared, which only slivers and pairs that
/// graze each other's plane come down to; two rectangles within 1e-11 of parallel or perpendicular
/// are taken so. Some 0.5 µs for rectangles with a common axis, 1 to 4 µs for far pairs, 10 to
/// 30 µs for others (to 120 µs where edges that touch are within 0.6° of parallel). Thread-safe;
/// the same bits for the same arguments.
double exchange_area(const Polygon& a, const Polygon& b);

/// F_ab: the share of what `from` sends out diffusely that reaches `to`; exchange_area / area.
double form_factor(const Polygon& from, const Polygon& to);

/// The form factor from a small area at `point` with unit `normal` to the front of `to`; on the
/// edge of `to` itself it has no value, and one of those nearby comes back. Some 0.15 µs (J.
/// Lambert, Photometria, 1760; D. Baum, H. Rushmeier, J. Winget, Improving radiosity solutions
/// through the use of analytically determined form-factors, SIGGRAPH 1989).
double point_form_factor(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to);

}  // namespace parallux
