#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "solve/direct_light.h"
#include "solve/pass.h"
#include "solve/small_patches.h"

namespace parallux {

/// The stages of a group of bundles, in their order.
enum class Stage : std::uint32_t {
    trial,    ///< of rays, once in a run; see try_rays()
    sources,  ///< first shots: of what emits,
    lights,   ///< of lights without area,
    shots,    ///< and of what is brightest then
    pass,
    local_paths,
    gather,
    local_rays
};

/// A group under way: all that its stages hand on. Wherever a stage asks its listener, this, the
/// banks and the estimate of the groups before are all that the rest of the run depends on, beside
/// what it was given: a stage that is entered again goes on with what it finds here.
struct Group {
    Stage stage = Stage::trial;
    std::uint64_t done = 0;  ///< of this stage: rays, sources, surfaces, patches or bundles
    DirectLight direct;
    TransferState state;
    PassResult pass;
    std::vector<SmallPatch> small;

    void enter(Stage next) {
        stage = next;
        done = 0;
    }
    /// Another group begins, with nothing but the direct light of the one before where all share
    /// it.
    void begin(bool shoots) {
        enter(shoots ? Stage::sources : Stage::pass);
        if (shoots)
            direct = {};
        state = {};
        pass = {};
        small.clear();
    }
};

}  // namespace parallux
