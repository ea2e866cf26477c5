#pragma once

#include <cstdint>
#include <vector>

#include "factors/form_factors.h"
#include "solve/emitters.h"

namespace parallux {

/// One polygon that emits evenly: a cell, or the whole of a surface.
struct Source {
    Polygon polygon;
    Emitter piece;
    std::vector<double> power;  ///< quanta, one a band
};

/// The emitters as few polygons: cells of one surface and side that all emit the same become one.
std::vector<Source> sources_of(const Scene& scene, const Patches& patches,
                               const Emitters& emitters);

/// How many of them the emission of the patches makes. Linear, without memory.
std::uint64_t count_sources(const Scene& scene, const Patches& patches);

}  // namespace parallux
