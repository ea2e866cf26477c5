#include "output/pieces.h"

#include <algorithm>
#include <numeric>

#include "parallux/error.h"

namespace parallux {

namespace {

// Row and place in the row of a triangle's cell; rows hold 2 (n - row) - 1 cells.
struct TriangleCell {
    std::uint32_t iu, iv;
    bool inverted;
};

TriangleCell triangle_cell(std::uint32_t n, std::uint32_t cell) {
    // Row iv begins at iv (2n - iv): find the last row that begins at or before the cell.
    std::uint32_t low = 0, high = n - 1;
    while (low < high) {
        std::uint32_t middle = (low + high + 1) / 2;
        if (middle * (2 * n - middle) <= cell)
            low = middle;
        else
            high = middle - 1;
    }
    std::uint32_t k = cell - low * (2 * n - low);
    return {k / 2, low, k % 2 == 1};
}

}  // namespace

CellCorners cell_corners(Shape shape, const SurfaceGrid& grid, std::uint32_t cell) {
    CellCorners corners;
    auto put = [&](std::uint32_t iu, std::uint32_t iv) {
        corners.uv[corners.count++] = {double(iu) / grid.nu, double(iv) / grid.nv};
    };
    if (shape == Shape::parallelogram) {
        std::uint32_t iu = cell % grid.nu, iv = cell / grid.nu;
        put(iu, iv), put(iu + 1, iv), put(iu + 1, iv + 1), put(iu, iv + 1);
    } else if (auto [iu, iv, inverted] = triangle_cell(grid.nu, cell); inverted) {
        put(iu + 1, iv + 1), put(iu, iv + 1), put(iu + 1, iv);
    } else {
        put(iu, iv), put(iu + 1, iv), put(iu, iv + 1);
    }
    return corners;
}

std::array<double, 4> corner_weights(Shape shape, const SurfaceGrid& grid, std::uint32_t cell,
                                     double u, double v) {
    double fu = u * grid.nu, fv = v * grid.nv;
    if (shape == Shape::parallelogram) {
        double a = std::clamp(fu - cell % grid.nu, 0.0, 1.0);
        double b = std::clamp(fv - cell / grid.nu, 0.0, 1.0);
        return {(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b};
    }
    auto [iu, iv, inverted] = triangle_cell(grid.nu, cell);
    double a = std::clamp(inverted ? 1 - (fu - iu) : fu - iu, 0.0, 1.0);
    double b = std::clamp(inverted ? 1 - (fv - iv) : fv - iv, 0.0, 1.0 - a);
    return {1 - a - b, a, b, 0};
}

Pieces::Pieces(const Scene& scene, const Patches& patches) {
    // Lay the cells of all surfaces in a row, fronts before backs.
    std::size_t surfaces = scene.surfaces.size();
    first_.resize(surfaces + 1);
    two_sided_.resize(surfaces);
    std::uint64_t total = 0;
    for (std::size_t s = 0; s < surfaces; ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        first_[s] = static_cast<std::uint32_t>(total);
        two_sided_[s] = grid.back != none;
        std::uint64_t cells = cell_count(scene.surfaces[s].shape(), grid);
        total += two_sided_[s] ? 2 * cells : cells;
        if (total >= none)
            throw Error(Fault::memory, "too many cells to interpolate; use larger patches");
    }
    first_[surfaces] = static_cast<std::uint32_t>(total);
    surface_.reserve(total);
    patch_.reserve(total);
    for (std::uint32_t s = 0; s < surfaces; ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        std::uint32_t cells = cell_count(scene.surfaces[s].shape(), grid);
        for (std::uint32_t side : {grid.front, grid.back})
            for (std::uint32_t cell = 0; side != none && cell < cells; ++cell) {
                surface_.push_back(s);
                patch_.push_back(side + cell);
            }
    }
    // Gather the pieces of each patch.
    member_begin_.assign(patches.count() + 1, 0);
    for (std::uint32_t patch : patch_)
        ++member_begin_[patch + 1];
    std::partial_sum(member_begin_.begin(), member_begin_.end(), member_begin_.begin());
    members_.resize(patch_.size());
    std::vector<std::uint32_t> next(member_begin_.begin(), member_begin_.end() - 1);
    for (std::uint32_t piece = 0; piece < patch_.size(); ++piece)
        members_[next[patch_[piece]]++] = piece;
}

bool Pieces::back(std::uint32_t piece) const {
    std::uint32_t s = surface_[piece];
    return two_sided_[s] && piece - first_[s] >= (first_[s + 1] - first_[s]) / 2;
}

std::uint32_t Pieces::cell(std::uint32_t piece) const {
    std::uint32_t s = surface_[piece], n = first_[s + 1] - first_[s];
    std::uint32_t within = piece - first_[s];
    return back(piece) ? within - n / 2 : within;
}

}  // namespace parallux
