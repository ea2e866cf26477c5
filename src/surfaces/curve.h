#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallux/scene.h"

// Curved surfaces: whatever has points over a (u, v) square. All that is known of one kind alone is
// in curve.cpp, its areas in curve_area.cpp and, where a line meets it in closed form, in
// curve_roots.cpp.

namespace parallux {

/// A point of a curve with its derivatives.
struct CurvePoint {
    glm::dvec3 at, per_u, per_v;
};
CurvePoint curve_at(const Curve& curve, double u, double v);

/// Unit ∂p/∂u × ∂p/∂v; at a pole, where that vanishes, what it tends to.
glm::dvec3 curve_normal(const Curve& curve, double u, double v);

/// Area of u0 … u1, v0 … v1.
double curve_area(const Curve& curve, double u0, double u1, double v0, double v1);

/// Of a rectangle of (u, v) with as many points a side; holds all of it.
Bounds curve_bounds(const Curve& curve, double u0, double u1, double v0, double v1, int points);

/// The point of that rectangle which parts its area in the shares a (along u) and b (along v): two
/// uniform numbers give a uniform point.
glm::dvec2 curve_place(const Curve& curve, double u0, double u1, double v0, double v1, double a,
                       double b);

/// Where 0 … 1 along u (or v) is to be cut so that chords, over any of the surface, stay within
/// `chord` metres of it and within `bend` of their own lengths; the limits of `cells` equal parts
/// are among the cuts. Throws Fault::memory beyond 2¹⁶.
std::vector<double> curve_cuts(const Curve& curve, bool along_u, std::uint32_t cells, double chord,
                               double bend);

/// Whether it is a sphere of which nothing is left out.
bool is_whole_sphere(const Curve& curve);
glm::dvec3 sphere_centre(const Curve& curve);

/// Whether it lies in one plane: disks and rings, whole or cut.
bool is_disk(const Curve& curve);
/// The square about a disk, counter-clockwise seen along its axis.
std::array<glm::dvec3, 4> disk_square(const Curve& curve);
/// Whether a point of its plane lies on a disk, and its (u, v).
bool on_disk(const Curve& curve, const glm::dvec3& point, double& u, double& v);

/// A line's crossing of a curve.
struct CurveRoot {
    double t, u, v;
};
/// Whether lines meet it in closed form: disks, cylinders, cones and spheres.
bool is_quadric(const Curve& curve);
/// All crossings of origin + t direction with such a curve, in no order; at most two.
int quadric_roots(const Curve& curve, const glm::dvec3& origin, const glm::dvec3& direction,
                  CurveRoot* roots);
/// Those with any other curve within u0 … u1, v0 … v1, which must be so small that its normals turn
/// by less than a right angle: by Newton's method from up to five places. At most four.
int newton_roots(const Curve& curve, const glm::dvec3& origin, const glm::dvec3& direction,
                 double u0, double u1, double v0, double v1, CurveRoot* roots);

}  // namespace parallux
