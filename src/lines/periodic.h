#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux {

/// Copies of a tile that a line may pass, at most, along one period.
inline constexpr double most_copies = 64;

/// Whether the scene repeats.
bool is_periodic(const Scene& scene);

/// Throws Fault::usage where copies of the tile, which lies in a sphere of this radius, would take
/// more lines across than a bundle has.
void check_copies(const Scene& scene, double radius, double spacing);

/// About how many copies of surfaces a bundle has at most: counted along 64 of the directions that
/// have most, linear in them, and a quarter more. 0 for scenes that do not repeat.
std::uint64_t most_copied_surfaces(const Scene& scene);

/// Bytes that those take in a bundle with its workspace.
std::uint64_t copies_bytes(const Scene& scene);

/// The cell of the lattice that a scene's periods make when seen along a direction.
class PeriodicCell {
public:
    PeriodicCell(const Scene& scene, const glm::dvec3& direction);

    /// A place in periods from the cell's middle; the cell is -1/2 … 1/2 in each.
    glm::dvec2 place(const glm::dvec3& position) const;
    bool two() const { return periods_.size() == 2; }
    const glm::dvec3& middle() const { return middle_; }
    /// The periods, and as they are seen.
    const std::vector<glm::dvec3>& periods() const { return periods_; }
    const glm::dvec3& seen(std::size_t k) const { return seen_[k]; }

    /// Calls visit(i, j) for every copy of a surface, moved by i and j periods, whose shadow
    /// overlaps the cell.
    template <class Visit>
    void each_copy(const Scene& scene, const Surface& surface, Visit&& visit) const;

private:
    glm::dvec3 middle_{0};  // of the tile
    glm::dvec3 seen_[2];
    glm::dvec3 along_[2];              // place: dot products with these
    glm::dvec2 across_{0};             // the shadow of the tile's height runs across this
    std::vector<glm::dvec3> periods_;  // one or two
};

/// The lines of one direction through a scene that repeats without end. Seen along ω it repeats
/// too, by the projections of its periods, so that the lines through one cell of that lattice stand
/// for all: every patch meets, in one copy or another, as many as it has in a scene that does not
/// repeat. The copies that overlap the cell, and no others, are projected. Near the horizon that
/// would be more than `most_copies`: such directions are tilted until it is not.
class PeriodicBundle {
public:
    /// Projects. Keeps no reference but to what it copies; linear in the copied surfaces.
    PeriodicBundle(const Scene& scene, const Patches& patches, const Bundle& bundle);
    PeriodicBundle(const PeriodicBundle&) = delete;

    std::size_t tiles() const { return projection_.tiles(); }
    std::shared_ptr<Projector::Workspace> make_workspace() const {
        return projector_->make_workspace();
    }
    /// The pairs of those lines of a tile that pass the cell; `lists` is scratch.
    void pairs(std::size_t tile, Projector::Workspace& workspace, IntersectionLists& lists,
               TilePairs& pairs) const;

    const glm::dvec3& direction() const { return bundle_.direction; }
    std::size_t copied_surfaces() const { return copies_.surfaces.size(); }

private:
    void copy_surfaces(const Scene& scene, const Patches& patches);
    bool in_cell(std::int32_t column, std::int32_t row) const;

    Bundle bundle_;
    PeriodicCell cell_;
    Scene copies_;
    Patches cells_;  // their grids alone
    std::shared_ptr<Projector> projector_;
    Projection projection_;
};

/// Says how many directions of a periodic scene are tilted; "" where it is less than one in a
/// hundred, or the scene is not periodic.
std::string tilt_warning(const Scene& scene);

}  // namespace parallux
