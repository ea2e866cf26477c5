#include "lines/facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "lines/rims.h"
#include "lines/welder.h"
#include "parallux/error.h"
#include "surfaces/curve.h"

namespace parallux {

namespace {

constexpr double bend = facet_bend, same_place = 1e-9;

// A curved surface cut along u and v; corners row by row.
struct Cut {
    std::uint32_t surface;
    std::vector<double> u, v;
    std::vector<std::uint32_t> corner;
    std::size_t first_rim = 0, end_rim = 0;

    std::uint32_t at(std::size_t i, std::size_t j) const { return corner[j * u.size() + i]; }
};

class Cutter {
public:
    Cutter(const Scene& scene, const Patches& patches, double chord, Spheres spheres)
        : scene_(scene), patches_(patches), chord_(chord), spheres_(spheres) {
        const Bounds bounds = scene_bounds(scene);
        tolerance_ = same_place * glm::length(bounds.high - bounds.low);
        facets_.scene.positions = scene.positions;
    }

    Facets cut() {
        Welder welder(scene_, facets_.scene.positions, tolerance_);
        for (std::uint32_t s = 0; s < scene_.surfaces.size(); ++s)
            if (!scene_.surfaces[s].is_curved())
                keep(s);
        for (std::uint32_t s = 0; s < scene_.surfaces.size(); ++s)
            if (scene_.surfaces[s].is_curved()) {
                if (is_ball(scene_.surfaces[s]))
                    halve(s);
                else
                    cut(s, welder);
            }
        find_rims();
        take_corners(scene_, facets_.scene.positions, {chord_, bend, tolerance_}, curved_rims_,
                     rims_);
        for (const Cut& cut : cuts_)
            emit(cut);
        for (const Rim& rim : rims_)
            emit(rim);
        return std::move(facets_);
    }

private:
    void keep(std::uint32_t s) {
        facets_.scene.surfaces.push_back(scene_.surfaces[s]);
        facets_.patches.grids.push_back(patches_.grids[s]);
        facets_.parent.push_back(s);
    }

    bool is_ball(const Surface& surface) const {
        return spheres_ == Spheres::halves && is_whole_sphere(scene_.curves[surface.curve]);
    }

    // Both halves have the centre for all corners.
    void halve(std::uint32_t s) {
        const Curve& curve = scene_.curves[scene_.surfaces[s].curve];
        Surface half;
        half.corner.fill(static_cast<std::uint32_t>(facets_.scene.positions.size()));
        half.curve = static_cast<std::uint32_t>(facets_.scene.curves.size());
        facets_.scene.positions.push_back(sphere_centre(curve));
        facets_.scene.curves.push_back(curve);
        for (std::uint16_t far : {std::uint16_t(0), std::uint16_t(1)}) {
            half.grid_u = far;
            facets_.scene.surfaces.push_back(half);
            facets_.patches.grids.push_back(patches_.grids[s]);
            facets_.parent.push_back(s);
        }
    }

    void cut(std::uint32_t s, Welder& welder) {
        const Curve& curve = scene_.curves[scene_.surfaces[s].curve];
        const SurfaceGrid& grid = patches_.grids[s];
        Cut cut{s,
                curve_cuts(curve, true, grid.nu, chord_, bend),
                curve_cuts(curve, false, grid.nv, chord_, bend),
                {},
                0,
                0};
        while (twisted(curve, cut)) {
            halve(cut.u);
            halve(cut.v);
        }
        count_ += 2 * cut.u.size() * cut.v.size();
        if (count_ > std::size_t(1) << 28)
            throw Error(Fault::memory,
                        "curved surfaces would be cut into more than 2^28 "
                        "triangles; choose a larger --line-spacing");
        for (std::size_t j = 0; j < cut.v.size(); ++j)
            for (std::size_t i = 0; i < cut.u.size(); ++i) {
                const glm::dvec3 p = curve_at(curve, cut.u[i], cut.v[j]).at;
                if (i == 0 || j == 0 || i + 1 == cut.u.size() || j + 1 == cut.v.size()) {
                    cut.corner.push_back(welder.weld(p));
                } else {
                    cut.corner.push_back(
                        static_cast<std::uint32_t>(facets_.scene.positions.size()));
                    facets_.scene.positions.push_back(p);
                }
            }
        cuts_.push_back(std::move(cut));
    }

    // Whether the diagonal of any quad lies too far from the surface.
    bool twisted(const Curve& curve, const Cut& cut) const {
        for (std::size_t j = 0; j + 1 < cut.v.size(); ++j)
            for (std::size_t i = 0; i + 1 < cut.u.size(); ++i) {
                const glm::dvec3 a = curve_at(curve, cut.u[i], cut.v[j]).at;
                const glm::dvec3 b = curve_at(curve, cut.u[i + 1], cut.v[j + 1]).at;
                const CurvePoint middle = curve_at(curve, 0.5 * (cut.u[i] + cut.u[i + 1]),
                                                   0.5 * (cut.v[j] + cut.v[j + 1]));
                const glm::dvec3 normal = glm::cross(middle.per_u, middle.per_v);
                const double length = glm::length(normal);
                if (length > 0 && std::fabs(glm::dot(middle.at - 0.5 * (a + b), normal)) >
                                      2.5 * length * std::min(chord_, bend * glm::distance(a, b)) +
                                          length * tolerance_)
                    return true;
            }
        return false;
    }

    static void halve(std::vector<double>& cuts) {
        std::vector<double> finer;
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            finer.push_back(cuts[k]);
            finer.push_back(0.5 * (cuts[k] + cuts[k + 1]));
        }
        finer.push_back(cuts.back());
        cuts = std::move(finer);
    }

    void find_rims() {
        // Round every surface as its facets go.
        for (Cut& cut : cuts_) {
            cut.first_rim = rims_.size();
            const std::size_t nu = cut.u.size() - 1, nv = cut.v.size() - 1;
            auto add = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
                add_rim(cut.surface, cut.at(i, j), cut.at(k, l), {cut.u[i], cut.v[j]},
                        {cut.u[k], cut.v[l]});
            };
            for (std::size_t i = 0; i < nu; ++i) {
                add(i, 0, i + 1, 0);
                add(i + 1, nv, i, nv);
            }
            for (std::size_t j = 0; j < nv; ++j) {
                add(nu, j, nu, j + 1);
                add(0, j + 1, 0, j);
            }
            cut.end_rim = rims_.size();
        }
        curved_rims_ = rims_.size();
        for (std::uint32_t s = 0; s < scene_.surfaces.size(); ++s) {
            const Surface& surface = scene_.surfaces[s];
            if (surface.is_curved())
                continue;
            const bool triangle = surface.shape() == Shape::triangle;
            const glm::dvec2 uv[4] = {
                {0, 0}, {1, 0}, triangle ? glm::dvec2(0, 1) : glm::dvec2(1), {0, 1}};
            const unsigned corners = triangle ? 3 : 4;
            for (unsigned k = 0; k < corners; ++k)
                add_rim(s, surface.corner[k], surface.corner[(k + 1) % corners], uv[k],
                        uv[(k + 1) % corners]);
        }
    }

    void add_rim(std::uint32_t s, std::uint32_t from, std::uint32_t to, glm::dvec2 uv_from,
                 glm::dvec2 uv_to) {
        if (from != to)
            rims_.push_back({s, from, to, uv_from, uv_to});
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t s,
                  std::uint32_t cell) {
        if (a == b || b == c || c == a)
            return;
        Surface facet;
        facet.corner = {a, b, c, none};
        facets_.scene.surfaces.push_back(facet);
        const SurfaceGrid& grid = patches_.grids[s];
        facets_.patches.grids.push_back(
            {grid.front + cell, grid.back == none ? none : grid.back + cell, 1, 1});
        facets_.parent.push_back(s);
    }

    std::uint32_t cell_of(std::uint32_t s, double u, double v) const {
        const SurfaceGrid& grid = patches_.grids[s];
        return cell_at(scene_.surfaces[s].shape(), grid.nu, grid.nv, static_cast<float>(u),
                       static_cast<float>(v));
    }

    using Parts = std::unordered_map<std::uint64_t, Rim*>;

    static std::uint64_t edge(std::uint32_t from, std::uint32_t to) {
        return std::uint64_t(from) << 32 | to;
    }

    // A triangle, parted at the corners that one of its edges has taken up.
    void parted_triangle(std::array<std::uint32_t, 3> c, const Parts& parts, std::uint32_t s,
                         std::uint32_t cell) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto found = parts.find(edge(c[k], c[(k + 1) % 3]));
            if (found == parts.end() || found->second->parted)
                continue;
            Rim& rim = *found->second;
            rim.parted = true;
            const std::uint32_t apex = c[(k + 2) % 3];
            triangle(apex, rim.from, rim.taken[0].corner, s, cell);
            for (std::size_t n = 0; n < rim.taken.size(); ++n)
                triangle(apex, rim.taken[n].corner, rim.end_of(n), s, cell);
            return;
        }
        triangle(c[0], c[1], c[2], s, cell);
    }

    void emit(const Cut& cut) {
        Parts parts;
        for (std::size_t r = cut.first_rim; r < cut.end_rim; ++r)
            if (!rims_[r].taken.empty())
                parts.emplace(edge(rims_[r].from, rims_[r].to), &rims_[r]);
        for (std::size_t j = 0; j + 1 < cut.v.size(); ++j)
            for (std::size_t i = 0; i + 1 < cut.u.size(); ++i) {
                const std::uint32_t cell = cell_of(cut.surface, 0.5 * (cut.u[i] + cut.u[i + 1]),
                                                   0.5 * (cut.v[j] + cut.v[j + 1]));
                const std::uint32_t a = cut.at(i, j), b = cut.at(i + 1, j),
                                    c = cut.at(i + 1, j + 1), d = cut.at(i, j + 1);
                parted_triangle({a, b, c}, parts, cut.surface, cell);
                parted_triangle({a, c, d}, parts, cut.surface, cell);
            }
    }

    // What lies between a facet's edge and the corners that it has taken up: nothing but rounding
    // where edges are straight, as those of planar surfaces.
    void emit(const Rim& rim) {
        if (rim.parted)
            return;
        for (std::size_t k = 0; k < rim.taken.size(); ++k) {
            // A little within the surface, to be in the cell beside the edge.
            const glm::dvec2 uv = rim.uv_from + rim.taken[k].along * (rim.uv_to - rim.uv_from);
            const glm::dvec2 within = uv + 1e-6 * (glm::dvec2(0.4) - uv);
            triangle(rim.from, rim.taken[k].corner, rim.end_of(k), rim.surface,
                     cell_of(rim.surface, within.x, within.y));
        }
    }

    const Scene& scene_;
    const Patches& patches_;
    double chord_, tolerance_ = 0;
    Spheres spheres_;
    std::size_t count_ = 0, curved_rims_ = 0;
    Facets facets_;
    std::vector<Cut> cuts_;
    std::vector<Rim> rims_;
};

}  // namespace

Facets make_facets(const Scene& scene, const Patches& patches, double chord, Spheres spheres) {
    return Cutter(scene, patches, chord, spheres).cut();
}

}  // namespace parallux
