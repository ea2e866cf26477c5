#include "solve/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "surfaces/curve.h"

namespace parallux {

namespace {

// Calls visit(emitter, area of its cell) for all cells and sides.
template <class Visit>
void for_all_cells(const Scene& scene, const Patches& patches, Visit&& visit) {
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        Shape shape = scene.surfaces[s].shape();
        const bool curved = scene.surfaces[s].is_curved();
        double equal = curved ? 0
                              : surface_area(scene, scene.surfaces[s]) /
                                    (static_cast<double>(grid.nu) * grid.nv);
        for (std::uint32_t first : {grid.front, grid.back})
            if (first != none)
                for_each_cell(shape, grid, [&](const Cell& cell) {
                    // A curved cell is a patch of its own.
                    const std::uint32_t patch = first + cell.index;
                    visit(Emitter{s, patch, first == grid.back, cell},
                          curved ? patches.area[patch] : equal);
                });
    }
}

void add(Emitters& emitters, const Emitter& piece, double share,
         std::span<const std::int64_t> power) {
    double sum = 0;
    for (std::int64_t quanta : power) {
        emitters.power.push_back(share * static_cast<double>(quanta));
        sum += emitters.power.back();
    }
    emitters.pieces.push_back(piece);
    emitters.up_to.push_back(emitters.total += sum);
}

void close(Emitters& emitters) {
    for (double& up_to : emitters.up_to)
        up_to /= emitters.total;
    // Where the search of each of as many equal steps begins.
    const std::size_t count = emitters.pieces.size();
    emitters.guide.resize(count);
    std::size_t piece = 0;
    for (std::size_t step = 0; step < count; ++step) {
        const double at = static_cast<double>(step) / static_cast<double>(count);
        while (piece + 1 < count && emitters.up_to[piece] <= at)
            ++piece;
        emitters.guide[step] = static_cast<std::uint32_t>(piece);
    }
}

}  // namespace

std::size_t Emitters::choose(double at) const {
    const auto step = static_cast<std::size_t>(at * static_cast<double>(guide.size()));
    std::size_t piece = guide[std::min(step, guide.size() - 1)];
    // Rounding may have begun a step too far.
    while (piece > 0 && up_to[piece - 1] > at)
        --piece;
    while (piece + 1 < pieces.size() && up_to[piece] <= at)
        ++piece;
    return piece;
}

Emitters emitters_of(const Scene& scene, const Patches& patches,
                     const std::function<std::int64_t(std::size_t)>& power) {
    auto power_of = [&](std::uint32_t patch) {
        std::array<std::int64_t, max_bands> own{};
        for (std::uint32_t band = 0; band < patches.bands; ++band)
            own[band] = power(std::size_t(patch) * patches.bands + band);
        return own;
    };
    auto any = [](const std::array<std::int64_t, max_bands>& own) {
        return std::any_of(own.begin(), own.end(), [](std::int64_t quanta) { return quanta > 0; });
    };
    // Count them first: arrays that grow leave the memory in pieces that stay with the process.
    std::size_t count = 0;
    for_all_cells(scene, patches,
                  [&](const Emitter& piece, double) { count += any(power_of(piece.patch)); });
    Emitters emitters;
    emitters.bands = patches.bands;
    emitters.pieces.reserve(count);
    emitters.power.reserve(count * patches.bands);
    emitters.up_to.reserve(count);
    for_all_cells(scene, patches, [&](const Emitter& piece, double area) {
        const auto own = power_of(piece.patch);
        if (any(own))
            add(emitters, piece, area / patches.area[piece.patch], {own.data(), patches.bands});
    });
    close(emitters);
    return emitters;
}

std::vector<Emitter> all_cells(const Scene& scene, const Patches& patches) {
    std::vector<Emitter> cells;
    std::size_t count = 0;
    for_all_cells(scene, patches, [&](const Emitter&, double) { ++count; });
    cells.reserve(count);
    for_all_cells(scene, patches, [&](const Emitter& cell, double) { cells.push_back(cell); });
    return cells;
}

PatchCells::PatchCells(const Scene& scene, const Patches& patches)
    : start_(patches.count() + 1, 0) {
    fill(scene, patches);
}

PatchCells::PatchCells(const Scene& scene, const Patches& patches,
                       std::vector<std::uint32_t> wanted)
    : wanted_(std::move(wanted)), start_(wanted_.size() + 1, 0) {
    if (!wanted_.empty())
        fill(scene, patches);
}

std::size_t PatchCells::find(std::uint32_t patch) const {
    if (wanted_.empty())
        return std::min<std::size_t>(patch, count());
    const auto found = std::lower_bound(wanted_.begin(), wanted_.end(), patch);
    return found != wanted_.end() && *found == patch
               ? static_cast<std::size_t>(found - wanted_.begin())
               : count();
}

void PatchCells::fill(const Scene& scene, const Patches& patches) {
    for_all_cells(scene, patches, [&](const Emitter& piece, double) {
        if (const std::size_t place = find(piece.patch); place < count())
            ++start_[place + 1];
    });
    for (std::size_t place = 0; place < count(); ++place)
        start_[place + 1] += start_[place];
    cells_.resize(start_.back());
    share_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for_all_cells(scene, patches, [&](const Emitter& piece, double area) {
        const std::size_t place = find(piece.patch);
        if (place == count())
            return;
        const std::uint32_t at = next[place]++;
        cells_[at] = piece;
        share_[at] = area / patches.area[piece.patch];
    });
}

Emitters PatchCells::emitters(std::uint32_t patch, std::span<const std::int64_t> power) const {
    Emitters emitters;
    emitters.bands = static_cast<std::uint32_t>(power.size());
    for (std::uint32_t k = start_[patch]; k < start_[patch + 1]; ++k)
        add(emitters, cells_[k], share_[k], power);
    close(emitters);
    return emitters;
}

const Emitter& PatchCells::choose(std::size_t patch, double at) const {
    std::uint32_t cell = start_[patch], last = start_[patch + 1] - 1;
    while (cell < last && at >= share_[cell])
        at -= share_[cell++];
    return cells_[cell];
}

glm::dvec3 point_on(const Scene& scene, const Emitter& emitter, double a, double b) {
    const Surface& surface = scene.surfaces[emitter.surface];
    if (surface.shape() == Shape::triangle) {
        double root = std::sqrt(a);
        a = 1 - root;
        b *= root;
    }
    return surface_point(scene, surface, emitter.cell.u0 + a * emitter.cell.du,
                         emitter.cell.v0 + b * emitter.cell.dv);
}

glm::dvec3 cosine_direction(const glm::dvec3& normal, double a, double b) {
    glm::dvec3 x, y;
    frame_across(normal, x, y);
    double r = std::sqrt(a), angle = 2 * pi * b;
    return r * std::cos(angle) * x + r * std::sin(angle) * y + std::sqrt(1 - a) * normal;
}

EmitterPlace place_on(const Scene& scene, const Emitter& emitter, double a, double b) {
    const Surface& surface = scene.surfaces[emitter.surface];
    if (!surface.is_curved())
        return {point_on(scene, emitter, a, b), emitter_normal(scene, emitter)};
    const Curve& curve = scene.curves[surface.curve];
    const Cell& c = emitter.cell;
    const glm::dvec2 uv = curve_place(curve, c.u0, c.u0 + c.du, c.v0, c.v0 + c.dv, a, b);
    const glm::dvec3 normal = curve_normal(curve, uv.x, uv.y);
    return {curve_at(curve, uv.x, uv.y).at, emitter.back ? -normal : normal};
}

Polygon polygon_of(const Scene& scene, const Emitter& emitter) {
    const Surface& surface = scene.surfaces[emitter.surface];
    const Cell& c = emitter.cell;
    auto at = [&](double u, double v) {
        return surface_point(scene, surface, c.u0 + u * c.du, c.v0 + v * c.dv);
    };
    Polygon polygon;
    polygon.add(at(0, 0));
    polygon.add(emitter.back ? at(0, 1) : at(1, 0));
    if (surface.shape() == Shape::parallelogram)
        polygon.add(at(1, 1));
    polygon.add(emitter.back ? at(1, 0) : at(0, 1));
    return polygon;
}

glm::dvec3 emitter_normal(const Scene& scene, const Emitter& emitter) {
    glm::dvec3 normal = surface_normal(scene, scene.surfaces[emitter.surface]);
    return emitter.back ? -normal : normal;
}

}  // namespace parallux
