#pragma once

#include <optional>
#include <string>
#include <vector>

#include "parallux/solve.h"
#include "solve/direct_light.h"
#include "solve/leftover.h"
#include "solve/run.h"

namespace parallux {

/// What a pass did, beside the energy that it moved in the state.
struct PassResult {
    std::optional<Leftover> leftover;  ///< what received energy is multiplied by; absent: by 1
    std::vector<double> ambient;  ///< irradiance that unshot energy stands for, a band; empty: 0
    LineCounts counts;
    std::uint64_t bundles = 0;  ///< done of those planned
    double done = 1;            ///< share of the planned emission that was sent
    bool whole = true;          ///< all that was planned is done
    std::vector<std::string> warnings;
};

/// What each exit carries of a patch's own power over the whole run.
void set_emission(const Run& run, const DirectLight& direct, TransferState& state);

/// What a line of this direction brings from the sky: its cell times π L, spread over the run as
/// emission is.
SkyQuanta sky_quanta(const Scene& scene, const Plan& plan, const glm::dvec3& direction);

}  // namespace parallux
