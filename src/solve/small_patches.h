#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solve/pass.h"
#include "solve/run.h"

// Patches too small for a run's lines: few lines leave them, and few of the lines that leave others
// end there, which is noise where they are bright.

namespace parallux {

struct SmallPatch {
    std::uint32_t patch = 0;
    std::array<double, max_bands> irradiance{};  ///< found by paths, W/m²
};

/// The patches below a sixteenth of the mean area that fewer than 32 of the gather's lines will
/// leave: those whose error weighs most by what the pass has found, as many as local paths can
/// serve in about half of the lines' time. None where none of them sends more than four times what
/// others do in the root mean square: lines do as well there. Not those in whose very place another
/// surface lies. In patch order. Tells in the pass's
/// warnings how many there are, and the name of the first. O(patches).
std::vector<SmallPatch> small_patches(const Run& run, const TransferState& state, PassResult& pass);

/// Their numbers.
std::vector<std::uint32_t> numbers_of(const std::vector<SmallPatch>& small);

/// W/m² of patch and band, k = patch · bands + band, that an exit of the gather carries: its
/// emission, and what leaves again of what the pass has found. `emission` in quanta of 1.
double sent_by_exit(const Run& run, const Emission& emission, const PassResult& pass,
                    std::size_t k);

}  // namespace parallux
