#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "factors/form_factors.h"
#include "parallux/patches.h"
#include "patches/patch_values.h"

namespace parallux {

/// One cell and side of one surface, which sends power.
struct Emitter {
    std::uint32_t surface, patch;
    bool back;
    Cell cell;
};

/// The cells of patches with power, and the power of each in quanta, bands together.
struct Emitters {
    std::vector<Emitter> pieces;
    std::vector<double> power;         ///< piece · bands + band
    std::vector<double> up_to;         ///< running share of the power, of all pieces; ends at 1
    std::vector<std::uint32_t> guide;  ///< where choose() begins
    double total = 0;                  ///< of all bands
    std::uint32_t bands = 0;

    /// Which piece a number of [0, 1) chooses, by power. O(1) in the mean.
    std::size_t choose(double at) const;
};

/// All cells whose patch has power: power(patch * bands + band) quanta. A patch of several cells
/// sends from each by its area. Linear in the cells.
Emitters emitters_of(const Scene& scene, const Patches& patches,
                     const std::function<std::int64_t(std::size_t)>& power);

/// All cells and sides, surface by surface.
std::vector<Emitter> all_cells(const Scene& scene, const Patches& patches);

/// The cells of patches, patch by patch, for shots from single patches. 100 bytes a cell.
class PatchCells {
public:
    /// Of all patches.
    PatchCells(const Scene& scene, const Patches& patches);
    /// Of those named, in ascending order; they go by their place there. Linear in all cells.
    PatchCells(const Scene& scene, const Patches& patches, std::vector<std::uint32_t> wanted);

    /// The cells of one patch, which has the powers given.
    Emitters emitters(std::uint32_t patch, std::span<const std::int64_t> power) const;

    /// The cell of a patch that a number of [0, 1) chooses, by area.
    const Emitter& choose(std::size_t patch, double at) const;

    /// How many patches there are here.
    std::size_t count() const { return start_.size() - 1; }
    /// The place of a patch among those named; count() when it is not.
    std::size_t find(std::uint32_t patch) const;

private:
    void fill(const Scene& scene, const Patches& patches);

    std::vector<std::uint32_t> wanted_;  // empty: all
    std::vector<std::uint32_t> start_;   // count() + 1 offsets
    std::vector<Emitter> cells_;
    std::vector<double> share_;  // of the patch's area
};

/// A uniform point of an emitter's cell from two numbers of [0, 1), and the unit normal there of
/// the side that emits.
struct EmitterPlace {
    glm::dvec3 point, normal;
};
EmitterPlace place_on(const Scene& scene, const Emitter& emitter, double a, double b);

/// The point alone, of planar surfaces.
glm::dvec3 point_on(const Scene& scene, const Emitter& emitter, double a, double b);

/// A direction by the cosine law about a unit normal, from two numbers of [0, 1).
glm::dvec3 cosine_direction(const glm::dvec3& normal, double a, double b);

/// The cell of a planar surface, its corners counter-clockwise seen from the side that emits.
Polygon polygon_of(const Scene& scene, const Emitter& emitter);

/// Unit normal of the side that emits, of planar surfaces.
glm::dvec3 emitter_normal(const Scene& scene, const Emitter& emitter);

}  // namespace parallux
