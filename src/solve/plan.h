#pragma once

#include <cstdint>
#include <vector>

#include "parallux/solve.h"
#include "solve/keeping.h"

namespace parallux {

/// Rounds of a run to a stated error, at most.
inline constexpr std::uint32_t most_rounds = 16;

/// What a few rays from the sources tell of direct light before a run.
struct Trial {
    bool known = false;
    double variance = 0;  ///< its relative quadratic error, times rays
    double lit_area = 0;  ///< area of a patch that sends it on, m²: mean, by power; 0: none known
};

/// The numbers of a run, all settled before its first group.
struct Plan {
    unsigned threads = 1;
    FirstShot first_shot = FirstShot::off;  ///< of area lights; never automatic
    std::uint64_t first_shot_rays = 0;      ///< of a group
    std::uint64_t light_walks = 0;          ///< of a group, from lights to mirrors and glass
    bool try_rays = false;                  ///< how many is for a trial to say
    Trial trial;
    double shot_rays = 0;            ///< of a later shot with as much power as all sources have
    double shot_effort = 1;          ///< of exact shots past what hides: samples, by its square
    std::uint32_t groups = 1;        ///< independent runs that the result is the mean of
    bool too_few = false;            ///< bundles, to state an error
    bool shoot_each = true;          ///< the first shots of all groups differ
    std::uint64_t bundles = 0;       ///< D of a group; for independent lines, of lines_a_unit each
    std::uint64_t lines = 0;         ///< independent lines in all, or particles
    std::uint64_t lines_a_unit = 0;  ///< independent lines that stand for one bundle
    double spacing = 0;              ///< δ, metres
    double cell = 0;                 ///< area across its direction that one line stands for, m²
    double emission_cell = 0;        ///< an exit carries emission_cell · E over the whole run
    std::uint32_t batch = 1;         ///< 0: lines one after the other
    std::uint64_t gathering = 0;     ///< of the bundles: the last ones, the closing gather
    std::uint64_t closing = 0;       ///< of the others: the last ones, that carry no new emission
    Keeping keeping;                 ///< of the pass's lines, for what is left over
    LineSphere sphere;
    double watts_per_quantum = 1;
    double highest_reflectance = 0;  ///< with transmittance
    std::uint64_t bank_bytes = 0;    ///< that the workers' deltas may take

    /// Bundles of the unshot/accumulated pass.
    std::uint64_t passing() const { return bundles - gathering; }
};

/// Settles every number from the scene, its patches, the settings and what a trial has told. Throws
/// Fault::usage for settings that contradict each other, Fault::memory when the run needs more than
/// allowed.
Plan make_plan(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const Trial& trial = {});

}  // namespace parallux
