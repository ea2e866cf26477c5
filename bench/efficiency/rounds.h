#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "efficiency/methods.h"
#include "efficiency/reference.h"

namespace parallux::efficiency {

enum class Clock {
    wall,       ///< what a user waits
    processor,  ///< what the process's threads took: of one thread the same on an idle machine
};

struct RoundSettings {
    int seeds = 5;    ///< runs of every method and length
    int lengths = 3;  ///< each four times the one before
    /// Seconds that the shortest length takes beyond a run of next to nothing; 0: few and always
    /// the same lengths, whatever they take.
    double shortest = 0.1;
    Clock clock = Clock::wall;
};

/// All runs of one method and length on one case, and what they come to.
struct Row {
    std::string scene, method;
    unsigned threads = 1;
    std::uint64_t length = 0;              ///< bundles, or lines where the method has none
    std::vector<double> wall, cpu;         ///< seconds, one a run
    std::vector<double> errors;            ///< quadratic, one a run
    std::vector<std::vector<float>> runs;  ///< B of each
    double lines = 0;                      ///< global lines, or rays of the local methods, of a run
    double first_shot_rays = 0;            ///< of a run
    double seconds = 0;                    ///< median by the clock that was asked for
    double quadratic_error = 0;            ///< mean over the runs, (W/m²)²
    double relative_rms = 0;               ///< its root over the reference's root mean square
    double gain = 0;                       ///< set by set_gains()
    double mean_error = 0;                 ///< quadratic error of the runs' mean
    double mean_expected = 0;              ///< the same, if chance and the reference were all
    double mean_bound = 0;                 ///< and what it would stay below with 99.9 % confidence
    double reference_share = 0;            ///< the reference's own quadratic error over the row's
};

/// One run, timed from solve()'s call to its return: set-up within, scene and patches without.
struct Timed {
    Solution solution;
    double wall = 0, cpu = 0;

    double seconds(Clock clock) const { return clock == Clock::wall ? wall : cpu; }
};
Timed timed_run(const Case& of, const Contender& contender, std::uint64_t length,
                std::uint64_t seed);

/// One method and length alone, all seeds.
Row run_row(const Case& of, const Reference& reference, const Contender& contender,
            std::uint64_t length, const RoundSettings& settings);

/// Runs all contenders at all lengths in turn, once a seed, so that a change of the machine's speed
/// meets all alike. Lengths are powers of two.
std::vector<Row> run_rounds(const Case& of, const Reference& reference,
                            const std::vector<Contender>& contenders,
                            const RoundSettings& settings);

double median(std::vector<double> values);

}  // namespace parallux::efficiency
