#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallux/patches.h"

namespace parallux {

/// One cell of a surface's grid as (u, v) corners: three on a triangle, four on a parallelogram.
struct CellCorners {
    std::array<glm::dvec2, 4> uv{};
    std::uint32_t count = 0;
};
CellCorners cell_corners(Shape shape, const SurfaceGrid& grid, std::uint32_t cell);

/// Weights of a cell's corners at (u, v): bilinear on a parallelogram, barycentric on a triangle.
/// They sum to one.
std::array<double, 4> corner_weights(Shape shape, const SurfaceGrid& grid, std::uint32_t cell,
                                     double u, double v);

/// Cells in a surface's grid.
inline std::uint32_t cell_count(Shape shape, const SurfaceGrid& grid) {
    return shape == Shape::parallelogram ? grid.nu * grid.nv : grid.nu * grid.nu;
}

/// Every cell of every surface and side in one row: those of a surface's front, then of its back.
/// A patch is one piece, or several when it is a cluster.
class Pieces {
public:
    Pieces(const Scene& scene, const Patches& patches);

    std::uint32_t count() const { return static_cast<std::uint32_t>(surface_.size()); }
    std::uint32_t index(std::uint32_t surface, bool back, std::uint32_t cell) const {
        return first_[surface] + (back ? (first_[surface + 1] - first_[surface]) / 2 : 0) + cell;
    }
    std::uint32_t surface(std::uint32_t piece) const { return surface_[piece]; }
    std::uint32_t patch(std::uint32_t piece) const { return patch_[piece]; }
    std::uint32_t cell(std::uint32_t piece) const;
    bool back(std::uint32_t piece) const;
    /// The pieces of a patch, in order.
    std::span<const std::uint32_t> of_patch(std::uint32_t patch) const {
        return {members_.data() + member_begin_[patch], members_.data() + member_begin_[patch + 1]};
    }

private:
    std::vector<std::uint32_t> first_;  // one a surface, and the end
    std::vector<bool> two_sided_;
    std::vector<std::uint32_t> surface_, patch_;
    std::vector<std::uint32_t> member_begin_, members_;
};

}  // namespace parallux
