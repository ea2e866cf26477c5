#include "efficiency/judge.h"

#include <algorithm>
#include <cmath>

#include "efficiency/quality.h"

namespace parallux::efficiency {

namespace {

std::vector<double> mean_of(const std::vector<std::vector<float>>& runs) {
    std::vector<double> mean(runs.front().size(), 0);
    for (const std::vector<float>& run : runs)
        for (std::size_t k = 0; k < mean.size(); ++k)
            mean[k] += run[k] / static_cast<double>(runs.size());
    return mean;
}

// (tr C)² / tr C² of the covariance C of a run's errors: how many patches err each for itself. The
// products of two runs' errors have the variance tr C²; 1 where runs are too few to tell.
double freedom(const Case& of, const Row& row, const std::vector<double>& mean, double variance) {
    double sum = 0, squares = 0, pairs = 0;
    for (std::size_t a = 0; a < row.runs.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            const double product = mean_product(
                of, [&](std::size_t k) { return row.runs[a][k] - mean[k]; },
                [&](std::size_t k) { return row.runs[b][k] - mean[k]; });
            sum += product;
            squares += product * product;
            ++pairs;
        }
    const double spread = pairs > 2 ? (squares - sum * sum / pairs) / (pairs - 1) : 0;
    return spread > 0 ? std::max(1.0, variance * variance / spread) : 1;
}

// What the ratio of two mean squares of so many degrees of freedom stays below with 99.9 %
// (E. Paulson, 1942, after Wilson and Hilferty). Below three of `below` that is without bound.
double f_bound(double above, double below) {
    constexpr double z = 3.0902;
    const double a = 2 / (9 * above), b = 2 / (9 * below);
    if ((1 - b) * (1 - b) <= z * z * b)
        return INFINITY;
    const double root = std::sqrt((1 - b) * (1 - b) * a + (1 - a) * (1 - a) * b - z * z * a * b);
    return std::pow(((1 - a) * (1 - b) + z * root) / ((1 - b) * (1 - b) - z * z * b), 3);
}

}  // namespace

// With R runs x about the reference b, whose mean is m: mean |x - b|² = |m - b|² + mean |x - m|²,
// and the latter is (R - 1) / R of the variance V of a run. Of |m - b|² chance explains V / R.
void judge(const Case& of, const Reference& reference, Row& row) {
    const auto runs = static_cast<double>(row.runs.size());
    for (double error : row.errors)
        row.quadratic_error += error / runs;
    row.relative_rms = std::sqrt(row.quadratic_error / reference.scale);
    row.reference_share = reference.quadratic_error() / row.quadratic_error;
    const std::vector<double> mean = mean_of(row.runs);
    row.mean_error = quadratic_error(of, mean, reference.radiosity);
    const double variance = (row.quadratic_error - row.mean_error) * runs / (runs - 1);
    row.mean_expected = variance / runs + reference.quadratic_error();
    // The freedom is an estimate from few runs: half of it is on the safe side.
    const double alike = std::max(1.0, freedom(of, row, mean, variance) / 2);
    row.mean_bound = row.mean_expected * f_bound(alike, alike * (runs - 1));
}

double bias_of(const Row& row) {
    const double square = std::max(0.0, row.mean_error - row.mean_expected);
    return row.relative_rms * std::sqrt(square / row.quadratic_error);
}

}  // namespace parallux::efficiency
