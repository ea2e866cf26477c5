#pragma once

#include <optional>

#include "factors/form_factors.h"

// The ways to an exchange area of two polygons that each lie in front of the other's plane.
// Exposed so that the tests can hold one against another.

namespace parallux {

/// Two rectangles with a common axis in parallel or perpendicular planes, by the sums of 16 terms;
/// nothing for other pairs. The absolute error is some 1e-15 of their joint extent squared. (J.
/// Ehlert, T. Smith, View factors for perpendicular and parallel rectangular plates, J.
/// Thermophysics and Heat Transfer 7(1), 1993.)
std::optional<double> rectangle_exchange(const Polygon& a, const Polygon& b);

/// Any pair, by Stokes' theorem: 1/2π ∮∮ ln r dr_a · dr_b, each pair of edges in closed form. The
/// absolute error is some 1e-14 of their joint extent squared.
double contour_exchange(const Polygon& a, const Polygon& b);

/// Pairs that are small against their distance, or of which one is small against its distance from
/// the other's edges, by Gauss-Legendre rules for an error of some 1e-11 of the value; nothing
/// where that would take more than 8 points a side.
std::optional<double> cubature_exchange(const Polygon& a, const Polygon& b);

/// point_form_factor without the cut at the horizon; can be negative.
double seen_from(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& to);

/// The mean of the corners.
glm::dvec3 centre(const Polygon& polygon);
/// The distance of the farthest corner from `point`.
double radius(const Polygon& polygon, const glm::dvec3& point);

}  // namespace parallux
