#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solve/pass.h"
#include "solve/run.h"

// Patches too small for a run's lines: few lines leave them, and few of the lines that leave others
// end there, which is noise where they are bright. Local paths serve them in both ways.

namespace parallux {

struct Group;

struct SmallPatch {
    std::uint32_t patch = 0;
    std::array<double, max_bands> irradiance{};  ///< found by paths, W/m²
};

/// The patches below a sixteenth of the mean area that fewer than 32 of the gather's lines will
/// leave: those whose error weighs most by what the pass has found, as many as local paths can
/// serve in about half of the lines' time. None where none of them sends more than four times what
/// others do in the root mean square: lines do as well there. In patch order. Tells in the pass's
/// warnings how many there are, and the name of the first. O(patches).
std::vector<SmallPatch> small_patches(const Run& run, const TransferState& state, PassResult& pass);

/// Their numbers.
std::vector<std::uint32_t> numbers_of(const std::vector<SmallPatch>& small);

/// Finds what arrives at small patches, beside the first shots, along 64 local paths each: by the
/// cosine law from a uniform point of the patch to what the other end sends by the pass. A path
/// that ends at a small patch goes on from there, reflected, until it ends elsewhere. Goes on
/// behind the small patches that are done; where it is stopped, the others are small no more.
void gather_locally(const Run& run, Group& group);

/// After closing_gather(), for which they were dark: adds what they send, along local
/// rays, 64 for each in the mean, and puts what gather_locally() found in its place. Takes the
/// banks. Goes on behind the rays that are done.
void shoot_locally(const Run& run, Group& group);

}  // namespace parallux
