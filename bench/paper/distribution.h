#pragma once

#include <string>
#include <vector>

namespace parallux::paper {

/// How the quadratic errors of many runs of one cell are spread, beside a χ².
struct Distribution {
    int figure = 0;
    std::uint32_t patches = 0;
    std::uint64_t lines = 0;
    std::vector<double> errors;
    double mean = 0, variation = 0;
    double paper_variation = 0;  ///< as the paper states it
    double freedom = 0;          ///< of the χ² with the runs' mean and variation: 2 / variation²
    double p_value = 0;          ///< Kolmogorov-Smirnov against that χ²
    double theory_variation = 0;  ///< from the covariance of the theory
    double theory_freedom = 0;
    double theory_mean = 0;
    double theory_p_value = 0;  ///< against the χ² of the theory's freedom, at the runs' mean
};

/// Cumulative distribution at x of a χ² with `freedom` degrees, scaled to the mean given.
double scaled_chi_square(double x, double mean, double freedom);

/// p-value of Kolmogorov and Smirnov for the values against a scaled χ² (M. Stephens, EDF
/// statistics for goodness of fit, JASA 69, 1974, for the finite sample). Parameters that were
/// fitted to the same values make it larger than it should be.
double kolmogorov_smirnov(std::vector<double> values, double mean, double freedom);

/// Writes the histogram of each, with the fitted density, as columns for plotting:
/// DIR/figure3_10000.dat …
void write_histograms(const std::string& folder, const std::vector<Distribution>& distributions);

}  // namespace parallux::paper
