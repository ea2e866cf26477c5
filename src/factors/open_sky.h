#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/scene.h"

// What a point sees of the sky past everything in a scene, in closed form.

namespace parallux {

/// All surfaces of a scene as polygons that hide the sky from both sides, with the edges that they
/// share. Constant after construction.
class SkyBlockers {
public:
    explicit SkyBlockers(const Scene& scene);

    class View;

private:
    struct Face {
        std::array<std::uint32_t, 4> corner{}, edge{};
        std::uint32_t size = 0;
    };
    struct Edge {
        std::array<std::uint32_t, 2> corner;
    };

    void join_triangles();
    bool join(Face& a, const Face& b, std::uint32_t edge) const;

    std::vector<glm::dvec3> corners_;  // each place once
    std::vector<Face> faces_;
    std::vector<Edge> edges_;
    glm::dvec3 up_;
};

/// The same from one patch after another; scratch of one thread.
///
/// The sky that a point sees is bounded by those parts of the faces' outlines that no face hides,
/// whatever lies in front of what; so each outline is cut by the cone of each face, an interval of
/// a line by half-spaces, and what is left summed up by Lambert's formula. An edge between two
/// faces on either side of it, as seen from the point, bounds nothing.
class SkyBlockers::View {
public:
    explicit View(const SkyBlockers& blockers) : all_(blockers) {}

    /// Turns to points in the convex hull of `patch`, which lies in a plane of unit `normal`:
    /// leaves out what cannot stand before their sky. Linear in the faces.
    void turn(std::span<const glm::dvec3> patch, const glm::dvec3& normal);
    /// The form factor from a small area at `point` to the sky: what of the directions above both
    /// the point's plane and the horizon no face hides. Exact but for rounding, some 1e-9. Time is
    /// that of outlines × faces in the same azimuths.
    double sky(const glm::dvec3& point);

private:
    struct Ray {
        glm::dvec3 direction;  // unit
        double over_normal, over_up, azimuth;
    };
    // What an outline must share with a face to be hidden by it: azimuths, and heights up to `top`.
    struct Reach {
        std::uint64_t sectors;
        double top;
    };
    struct Cone {
        std::array<glm::dvec3, 4> inward;  // unit normals of its sides
        std::array<std::uint32_t, 4> edge;
        std::uint32_t face, size;
    };
    struct Plane {
        glm::dvec3 normal;  // unit, of the way from the lower to the higher corner
        double sine;        // of the angle that the edge subtends
        std::uint32_t faces_on, face;
    };
    struct Arc {
        glm::dvec3 from, to, inward;
        Reach reach;  // top: its lowest
        std::uint32_t edge, face;
    };

    void keep(std::uint32_t face);
    void order(const glm::dvec3& point);
    Ray ray_to(const glm::dvec3& place, const glm::dvec3& point) const;
    void look(const glm::dvec3& point);
    void look_at(const Face& face);
    bool outline(std::size_t edge, Arc& arc) const;
    double open_part(const Arc& arc);
    bool hides(const Cone& cone, const Arc& arc, double& begin, double& end) const;
    double open_horizon();

    const SkyBlockers& all_;
    glm::dvec3 normal_{0}, east_{0}, north_{0};
    std::vector<std::uint8_t> over_;              // of each corner of all: 1 horizon, 2 plane
    std::vector<std::uint32_t> corner_, edge_;    // of each of all, its place here
    std::vector<std::uint32_t> corners_, edges_;  // what is left, as numbered in all
    std::vector<Face> faces_;                     // numbered as here
    std::vector<Ray> rays_;
    std::vector<Plane> planes_;
    std::vector<Reach> reaches_;
    std::vector<Cone> cones_;
    std::vector<std::pair<double, double>> open_, left_;
};

}  // namespace parallux
