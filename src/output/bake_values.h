#pragma once

#include <optional>

#include "output/interpolate.h"
#include "parallux/bake.h"

namespace parallux {

/// A quantity at any point of a solved scene, as pictures show it.
class BakeValues {
public:
    /// Keeps references to all. Cost: that of Interpolation, unless flat.
    BakeValues(const Scene& scene, const Patches& patches, const Solution& solution,
               const BakeSettings& settings);

    std::uint32_t bands() const { return solution_.bands; }

    /// One value a band at (u, v) as one cell of the surface's grid sees it; (u, v) may lie on the
    /// cell's border, where other cells may see another value.
    void in_cell(std::uint32_t surface, bool back, std::uint32_t cell, double u, double v,
                 float* values) const;
    /// The same as the cell at (u, v) sees it.
    void at(std::uint32_t surface, bool back, double u, double v, float* values) const;

private:
    const Scene& scene_;
    const Patches& patches_;
    const Solution& solution_;
    BakeSettings settings_;
    RayScene rays_;
    std::optional<Interpolation> field_;  // none: flat
};

/// Whether a baked glTF shows a material's own picture, which colours then have to leave out.
bool keeps_picture(const Scene& scene, const BakeSettings& settings, std::uint32_t material);

/// Three bands as they are, else their mean three times.
glm::vec3 colour_of(const float* values, std::uint32_t bands);

}  // namespace parallux
