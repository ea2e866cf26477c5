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
    glm::dvec2 cell_place(const glm::dvec3& position) const;
    bool in_cell(std::int32_t column, std::int32_t row) const;

    Bundle bundle_;
    glm::dvec3 middle_{0};             // of the tile; the cell's middle
    glm::dvec3 along_[2];              // place in the cell, in periods: dot products with these
    std::vector<glm::dvec3> periods_;  // one or two
    Scene copies_;
    Patches cells_;  // their grids alone
    std::shared_ptr<Projector> projector_;
    Projection projection_;
};

/// Says how many directions of a periodic scene are tilted; "" where it is less than one in a
/// hundred, or the scene is not periodic.
std::string tilt_warning(const Scene& scene);

}  // namespace parallux
