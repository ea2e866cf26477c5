#pragma once

#include <functional>
#include <map>

#include <glm/geometric.hpp>

#include "output/pieces.h"
#include "parallux/patches.h"
#include "parallux/solve.h"

// Scenes, patches and solutions made by hand, with irradiance as a formula.

namespace parallux::hand_made {

using glm::dvec3;

/// Irradiance at a point of a surface with this normal, all bands alike.
using Field = std::function<double(const dvec3& point, const dvec3& normal)>;

struct Case {
    Scene scene;
    Patches patches;
    Solution solution;

    std::uint32_t position(const dvec3& p) {
        for (std::uint32_t i = 0; i < scene.positions.size(); ++i)
            if (glm::distance(scene.positions[i], p) < 1e-12)
                return i;
        scene.positions.push_back(p);
        return static_cast<std::uint32_t>(scene.positions.size() - 1);
    }

    std::uint32_t material(const Spectrum& reflectance, bool two_sided = false,
                           const Spectrum& emission = {}) {
        Material m;
        m.reflectance = reflectance;
        m.emission = emission;
        m.two_sided = two_sided;
        scene.materials.push_back(m);
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    }

    /// A parallelogram from p along a and b; its front looks along a × b.
    void quad(const dvec3& p, const dvec3& a, const dvec3& b, std::uint32_t nu, std::uint32_t nv,
              std::uint32_t of_material = 0) {
        Surface s;
        s.corner = {position(p), position(p + a), position(p + a + b), position(p + b)};
        s.material = of_material;
        s.grid_u = static_cast<std::uint16_t>(nu), s.grid_v = static_cast<std::uint16_t>(nv);
        scene.surfaces.push_back(s);
    }

    void triangle(const dvec3& p, const dvec3& q, const dvec3& r, std::uint32_t n,
                  std::uint32_t of_material = 0) {
        Surface s;
        s.corner = {position(p), position(q), position(r), none};
        s.material = of_material;
        s.grid_u = s.grid_v = static_cast<std::uint16_t>(n);
        scene.surfaces.push_back(s);
    }

    /// A box that looks outwards; each face has n × n cells.
    void box(const dvec3& low, const dvec3& size, std::uint32_t n, std::uint32_t of_material = 0) {
        dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), high = low + size;
        quad(low, y, x, n, n, of_material), quad(high, -x, -y, n, n, of_material);
        quad(low, x, z, n, n, of_material), quad(high, -z, -x, n, n, of_material);
        quad(low, z, y, n, n, of_material), quad(high, -y, -z, n, n, of_material);
    }

    /// One patch a cell and side, and irradiance `field` as each cell's mean over many points.
    void divide(const Field& field) {
        patches = {}, solution = {};
        patches.bands = solution.bands = scene.bands;
        for (const Surface& s : scene.surfaces) {
            SurfaceGrid grid;
            grid.nu = s.grid_u, grid.nv = s.grid_v;
            for (int side = 0; side < (scene.materials[s.material].two_sided ? 2 : 1); ++side) {
                (side ? grid.back : grid.front) = static_cast<std::uint32_t>(patches.count());
                for (std::uint32_t c = 0; c < cell_count(s.shape(), grid); ++c)
                    add_patch(s, grid, c, side ? -1.0 : 1.0, field);
            }
            patches.grids.push_back(grid);
        }
    }

private:
    void add_patch(const Surface& s, const SurfaceGrid& grid, std::uint32_t cell, double side,
                   const Field& field) {
        CellCorners c = cell_corners(s.shape(), grid, cell);
        glm::dvec2 a = c.uv[1] - c.uv[0], b = c.uv[c.count - 1] - c.uv[0];
        double sum = 0;
        constexpr int n = 32;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                double x = (i + 0.5) / n, y = (j + 0.5) / n;
                glm::dvec2 uv = c.uv[0] + x * a + y * b;
                sum += field(surface_point(scene, s, uv.x, uv.y), side * surface_normal(scene, s));
            }
        if (c.count == 3) {
            glm::dvec2 uv = (c.uv[0] + c.uv[1] + c.uv[2]) / 3.0;
            sum =
                n * n * field(surface_point(scene, s, uv.x, uv.y), side * surface_normal(scene, s));
        }
        patches.area.push_back(surface_area(scene, s) / cell_count(s.shape(), grid));
        const Material& m = scene.materials[s.material];
        for (std::uint32_t band = 0; band < scene.bands; ++band) {
            float h = static_cast<float>(sum / (n * n));
            patches.reflectance.push_back(m.reflectance[band]);
            patches.emission.push_back(m.emission[band]);
            solution.irradiance.push_back(h);
            solution.radiosity.push_back(m.emission[band] + m.reflectance[band] * h);
        }
    }
};

}  // namespace parallux::hand_made
