#pragma once

#include "error_bars/parts.h"
#include "error_bars/reference.h"

namespace parallux::error_bars {

/// What many runs come to, value by value (patch · bands + band) and run by run.
struct Tally {
    Tally(const Place& place, const Reference& reference, const std::vector<Solution>& runs);

    struct Value {
        bool counts = false;   ///< has an error at all
        double covered = 0;    ///< share of the runs whose interval holds the reference
        double mean = 0;       ///< of the error
        double variance = 0;   ///< of the runs
        double stated = 0;     ///< mean of the runs' squared standard errors
        double kurtosis = 0;   ///< excess, of the runs
        double exits = 0;      ///< lines that leave the patch, of the first run
        double radiosity = 0;  ///< the reference's
    };
    std::vector<Value> values;
    double covered = 0;             ///< over all values that count
    double bounded = 0;             ///< share of runs whose error is below their bound
    double actual = 0, stated = 0;  ///< root mean squares over the runs of the relative RMS
    double reference_ratio = 0;     ///< rms of the reference's error over rms of the stated one
    double worst_reference_ratio = 0;
    std::size_t runs = 0;
};

/// By quarters of exits, of brightness and of kurtosis, and the values covered worst.
void print_where(const Tally& tally);

/// Quarters of all values, by a property.
Json quarters(const Tally& tally, const char* name, double Tally::Value::*property, bool print);

}  // namespace parallux::error_bars
