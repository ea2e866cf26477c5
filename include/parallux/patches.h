#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/scene.h"

// Stage 2: the pieces that carry one value each.

namespace parallux {

/// Where a surface's cells are found among the patches.
///  parallelogram: nu × nv cells, cell = iv nu + iu
///  triangle:      nu == nv == n gives n² triangles, by rows of v; see cell_at
///  several surfaces may share one patch (a cluster): then nu == nv == 1
struct SurfaceGrid {
    std::uint32_t front = none;  ///< first patch of the front
    std::uint32_t back = none;   ///< first patch of the back; none on one-sided surfaces
    std::uint32_t nu = 1;
    std::uint32_t nv = 1;
};

/// All patches as arrays; values per band lie together: reflectance[patch * bands + band].
struct Patches {
    std::uint32_t bands = 0;
    std::vector<SurfaceGrid> grids;  ///< one a surface
    std::vector<double> area;        ///< m², one a patch and side
    std::vector<float> reflectance;
    std::vector<float> emission;  ///< W/m²
    /// Share of what arrives that leaves from the other side; empty where nothing lets light
    /// through.
    std::vector<float> transmittance;
    std::vector<std::uint32_t> other;  ///< patch of the other side, or none; filled beside those
    /// Share of what arrives that mirrors and glass take, one a patch; empty where there are none.
    /// Irradiance is what the diffuse part gets: that share left out.
    std::vector<float> specular;
    std::uint32_t clusters = 0;  ///< patches (cells) shared by more than one surface
    double size = 0;             ///< the patch side that was aimed at; 0: grids given

    std::size_t count() const { return area.size(); }
    bool translucent() const { return !transmittance.empty(); }
    float specular_share(std::size_t patch) const { return specular.empty() ? 0 : specular[patch]; }
    /// Share of what arrives that leaves again, from either side; k = patch * bands + band.
    float albedo(std::size_t k) const {
        return translucent() ? reflectance[k] + transmittance[k] : reflectance[k];
    }
    /// The same band of the other side, or no_side; only where translucent().
    std::size_t across(std::size_t k) const {
        const std::uint32_t side = other[k / bands];
        return side == none ? no_side : side * std::size_t(bands) + k % bands;
    }
    static constexpr std::size_t no_side = ~std::size_t(0);
};

struct PatchSettings {
    double size = 0;          ///< wanted patch side in metres; 0: from `count`
    std::uint64_t count = 0;  ///< wanted number of patches; 0 with size 0: 10 000
    bool clusters = true;     ///< let fine triangles share patches
    double crease = 0.35;     ///< radians: a cluster's normals stay this close to its first one's
};

/// Divides every surface into cells of about the wanted size, and joins triangles finer than that
/// into clusters (connected, one material, nearly one normal). Reflectance and emission are
/// averaged over each patch. Linear in surfaces and patches. Throws Fault::input when nothing with
/// area is left, Fault::memory when a grid would need more than 2³¹ patches.
Patches make_patches(const Scene& scene, const PatchSettings& settings = {});

/// The cell of a surface's grid at (u, v); arguments outside [0, 1] count as the nearest cell.
inline std::uint32_t cell_at(Shape shape, std::uint32_t nu, std::uint32_t nv, float u, float v) {
    float fu = u * static_cast<float>(nu), fv = v * static_cast<float>(nv);
    // The comparisons are written so that NaN falls to cell 0.
    auto clamp_cell = [](float f, std::uint32_t n) {
        return f > 0 ? (f < static_cast<float>(n) ? static_cast<std::uint32_t>(f) : n - 1) : 0u;
    };
    std::uint32_t iu = clamp_cell(fu, nu), iv = clamp_cell(fv, nv);
    if (shape == Shape::parallelogram)
        return iv * nu + iu;
    // Row iv of a triangle of n rows holds 2 (n - iv) - 1 cells: upright and inverted in turn.
    std::uint32_t n = nu, in_row = n - iv;
    if (iu >= in_row)
        iu = in_row - 1;
    bool inverted = (fu - static_cast<float>(iu)) + (fv - static_cast<float>(iv)) > 1.0f;
    std::uint32_t k = 2 * iu + (inverted && iu + 1 < in_row ? 1u : 0u);
    return iv * (2 * n - iv) + k;
}

/// What a table or a picture wants to know of a patch; made on demand, not stored in the solver.
struct PatchPlace {
    std::uint32_t surface = none;  ///< the first surface that maps to it
    std::uint32_t iu = 0, iv = 0;  ///< cell; on a triangle iu counts cells along the row
    bool back = false;
    glm::dvec3 centre{0};  ///< centroid
    glm::dvec3 normal{0};  ///< unit, of the patch's own side
};

/// One a patch, in patch order. Linear.
std::vector<PatchPlace> patch_places(const Scene& scene, const Patches& patches);

/// Those of patches first … end - 1 alone. Linear in the surfaces and in the cells of those met.
std::vector<PatchPlace> patch_places(const Scene& scene, const Patches& patches, std::size_t first,
                                     std::size_t end);

}  // namespace parallux
