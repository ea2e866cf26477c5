#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "efficiency/cases.h"

namespace parallux::efficiency {

struct ReferenceSettings {
    std::filesystem::path folder;     ///< where references are kept
    std::uint64_t bundles = 200'000;  ///< of each run: 200 times those of some tenths of a second
    unsigned threads = 0;             ///< 0: all
};

/// One of the long runs that a reference is the mean of.
struct LongRun {
    std::string first_shot;
    std::uint64_t seed = 0;
    std::uint64_t bundles = 0;
    double relative_rms = 0;        ///< stated by the run itself
    double relative_rms_bound = 0;  ///< likewise, with 95 % confidence
    double seconds = 0;
};

/// One run against others, relative RMS.
struct Check {
    double difference = 0;
    double expected = 0;  ///< by what both state
    double bound = 0;     ///< below it by the bounds of 95 % that both state; 0: not checked

    bool agrees() const { return difference <= bound; }
    /// A systematic error of one that would be overlooked.
    double blind() const { return std::sqrt(bound * bound - expected * expected); }
};

/// What rows are judged by, B per patch and band.
struct Reference {
    std::vector<double> radiosity;
    double scale = 0;      ///< mean square of B*, (W/m²)²
    double stated = 0;     ///< relative RMS error of the mean, as its runs state it
    double bound = 0;      ///< and what it is below with 95 % confidence
    double own_error = 0;  ///< relative RMS, with what the check of an exact first shot overlooks
    Check rays;            ///< the run after rays against the one without first shot
    Check exact;           ///< the one after an exact first shot against the mean of these
    std::vector<LongRun> runs;  ///< those in the mean
    bool cached = false;

    double quadratic_error() const { return scale * own_error * own_error; }
};

/// Whether exact first shots are tried at all: their cost grows with emitting surfaces × patches.
bool exact_is_affordable(const Case& of);

/// The mean of long runs by bundles, each under a seed of its own and weighted by the inverse of
/// its stated variance: one without first shot, one after rays, and one after an exact first shot
/// where that is affordable and agrees with the others. Read from the folder when it was left there
/// for the same case and length; else made, and left there. Throws Fault::output when it cannot be.
Reference make_reference(const Case& of, const ReferenceSettings& settings);

/// Prints the runs and the checks of one against the other.
void print_reference(const Case& of, const Reference& reference);

}  // namespace parallux::efficiency
