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
    std::uint64_t bundles = 819'200;  ///< of each of the two runs: 200 times the program's default
    unsigned threads = 0;             ///< 0: all
};

/// One of the two long runs that a reference is the mean of.
struct LongRun {
    std::string first_shot;
    std::uint64_t seed = 0;
    std::uint64_t bundles = 0;
    double relative_rms = 0;        ///< stated by the run itself
    double relative_rms_bound = 0;  ///< likewise, with 95 % confidence
    double seconds = 0;
};

/// What rows are judged by, B per patch and band.
struct Reference {
    std::vector<double> radiosity;
    double scale = 0;            ///< mean square of B*, (W/m²)²
    double quadratic_error = 0;  ///< its own, as its two runs state it
    double difference = 0;       ///< of the two runs, relative RMS
    double stated = 0;           ///< the difference that their standard errors make one expect
    double bound = 0;            ///< and what it is below by their bounds of 95 %
    std::vector<LongRun> runs;
    double refused = 0;  ///< difference of an exact first shot that did not agree; 0: none was
    bool cached = false;

    /// Whether the two runs are as close as they claim to be.
    bool agrees() const { return difference <= bound; }
    /// Relative RMS of a systematic error of one run that agrees() would overlook in the mean.
    double blind() const { return std::sqrt(bound * bound - stated * stated); }
};

/// Whether exact first shots are tried at all: their cost grows with emitting surfaces × patches.
bool exact_is_affordable(const Case& of);

/// Two runs by bundles under seeds of their own: one after an exact first shot, where that is
/// affordable, and one without any; two without any where these do not agree, because no first shot
/// is none that could be wrong. The reference is their mean, each weighted by the inverse of
/// its stated variance. Read from the folder when a run of the same case and length was left there;
/// else made, and left there. Throws Fault::output when it cannot be.
Reference make_reference(const Case& of, const ReferenceSettings& settings);

/// Prints the runs and the check of one against the other.
void print_reference(const Case& of, const Reference& reference);

}  // namespace parallux::efficiency
