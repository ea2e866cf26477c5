#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lines/ray_scene.h"
#include "output/exposed.h"

namespace parallux {

/// How far a patch's irradiance reaches, in patch sides.
inline constexpr double reach_in_sides = 2.3;

/// For each patch the others whose irradiance may be mixed with its own: near, on the same smooth
/// surface (joined over edges without a crease, or in one plane) and not behind another surface.
/// Symmetric: j is a neighbour of i exactly when i is one of j.
class Neighbours {
public:
    /// n log n in patches and edges, parallel, the same for any number of threads.
    Neighbours(const Scene& scene, const std::vector<ExposedPatch>& patches, const RayScene& rays,
               unsigned threads);

    /// Ascending, the patch itself left out.
    std::span<const std::uint32_t> of(std::uint32_t patch) const {
        return {list_.data() + begin_[patch], list_.data() + begin_[patch + 1]};
    }
    bool joined(std::uint32_t a, std::uint32_t b) const;

private:
    std::vector<std::uint64_t> begin_;
    std::vector<std::uint32_t> list_;
};

}  // namespace parallux
