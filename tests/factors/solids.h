#pragma once

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "factors/form_factors.h"
#include "factors/ways.h"

// Convex solids seen from inside, and rotations, for the tests of form factors.

namespace parallux::test {

using Vec = glm::dvec3;

inline Polygon parallelogram(const Vec& origin, const Vec& u, const Vec& v) {
    return {origin, origin + u, origin + u + v, origin + v};
}

/// The same polygon seen from the other side.
inline Polygon turned_over(const Polygon& polygon) {
    Polygon result;
    for (std::size_t k = polygon.size(); k-- > 0;)
        result.add(polygon[k]);
    return result;
}

/// x → M x by the columns of M.
struct Map {
    Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vec operator()(const Vec& p) const { return p.x * x + p.y * y + p.z * z; }
    Polygon operator()(const Polygon& polygon) const {
        Polygon result;
        for (const Vec& corner : polygon)
            result.add((*this)(corner));
        return result;
    }
};

/// A rotation that leaves no axis in place.
inline Map odd_rotation() {
    Vec x = glm::normalize(Vec(0.36, 0.48, -0.8)), y = glm::normalize(Vec(0.7, -0.4, 0.075));
    y = glm::normalize(y - glm::dot(x, y) * x);
    return {x, y, glm::cross(x, y)};
}

using Solid = std::vector<Polygon>;

/// Turns every face so that it faces the inside of the convex solid.
inline Solid seen_from_inside(Solid solid) {
    Vec middle(0);
    for (const Polygon& face : solid)
        middle += centre(face) / static_cast<double>(solid.size());
    for (Polygon& face : solid)
        if (glm::dot(area_vector(face), middle - face[0]) < 0)
            face = turned_over(face);
    return solid;
}

/// The faces a solid has over these corners, by their indices.
inline Solid solid(const std::vector<Vec>& corners,
                   const std::vector<std::vector<std::size_t>>& faces) {
    Solid result;
    for (const auto& face : faces) {
        result.emplace_back();
        for (std::size_t corner : face)
            result.back().add(corners[corner]);
    }
    return seen_from_inside(result);
}

/// The box 0 … sides, the two faces across axis k cut into cuts[k]² parts each.
inline Solid box(const Vec& sides, const std::vector<int>& cuts) {
    Solid result;
    for (int axis = 0; axis < 3; ++axis)
        for (double level : {0.0, 1.0}) {
            Vec origin(0), u(0), v(0);
            int n = cuts[std::size_t(axis)], axis_u = (axis + 1) % 3, axis_v = (axis + 2) % 3;
            origin[axis] = level * sides[axis];
            u[axis_u] = sides[axis_u] / n;
            v[axis_v] = sides[axis_v] / n;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    result.push_back(parallelogram(origin + double(i) * u + double(j) * v, u, v));
        }
    return seen_from_inside(result);
}

/// The solid with every face cut into triangles.
inline Solid triangles(const Solid& solid) {
    Solid result;
    for (const Polygon& face : solid)
        for (std::size_t k = 2; k < face.size(); ++k)
            result.push_back({face[0], face[k - 1], face[k]});
    return result;
}

inline Solid mapped(const Map& map, const Solid& solid) {
    Solid result;
    for (const Polygon& face : solid)
        result.push_back(map(face));
    return seen_from_inside(result);
}

/// The largest |Σ_j F_ij - 1| of a closed solid.
inline double worst_row(const Solid& solid) {
    double worst = 0;
    for (const Polygon& from : solid) {
        double sum = 0;
        for (const Polygon& to : solid)
            sum += form_factor(from, to);
        worst = std::fmax(worst, std::fabs(sum - 1));
    }
    return worst;
}

}  // namespace parallux::test
