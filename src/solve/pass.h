#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parallux/solve.h"
#include "solve/direct_light.h"
#include "solve/leftover.h"
#include "solve/run.h"

namespace parallux {

/// What a pass did, beside the energy that it moved in the state.
struct PassResult {
    std::unique_ptr<Leftover> leftover;  ///< what received energy is multiplied by; absent: by
    double received = 1;                 ///< this
    std::vector<double> ambient;    ///< irradiance that unshot energy stands for, a band; empty: 0
    Balance balance;                ///< set by end_pass(), as are
    std::vector<float> irradiance;  ///< beside direct light, patch · bands + band
    std::vector<std::uint64_t> crossings;  ///< lines that left each patch
    LineCounts counts;
    std::uint64_t bundles = 0;  ///< done of those planned
    std::uint32_t batch = 0;    ///< of those, the next to be done at once; 0: none is settled yet
    double done = 1;            ///< share of the planned emission that was sent
    bool whole = true;          ///< all that was planned is done
    std::vector<std::string> warnings;
};

/// Quanta of an exit per W/m² of emission: its cell, of the whole run, in quanta of the state.
double emission_quanta(const Plan& plan, const TransferState& state);

/// So large a quantum, a power of two times the plan's, that what exits carry of the emission fits
/// 32 bits with room for what they carry of the unshot energy: a surface that is as white as the
/// whitest may be 1 / (1 - ρ) times as bright as all that emits, and now and then wait for an exit.
double carried_quantum(const Run& run, const Emission& emission);

/// What a line of this direction brings from the sky, `unit` quanta per W/m² of π L.
SkyQuanta sky_quanta(const Scene& scene, double unit, const glm::dvec3& direction);

}  // namespace parallux
