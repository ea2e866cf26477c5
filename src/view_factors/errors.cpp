#include "view_factors/errors.h"

#include <algorithm>
#include <cmath>

namespace parallux {

namespace {

// Square of the standard error of the mean of `groups` values.
double square_of_mean(double sum, double squares, double groups) {
    return std::max(0.0, squares - sum * sum / groups) / (groups * (groups - 1));
}

std::vector<double> errors_of(const PairCounts::Shares& shares, double groups) {
    std::vector<double> errors(shares.sum.size());
    for (std::size_t k = 0; k < errors.size(); ++k)
        errors[k] = std::sqrt(square_of_mean(shares.sum[k], shares.squares[k], groups));
    return errors;
}

}  // namespace

void set_errors(const PairCounts& counts, const SparseRows& rows, Factors& factors) {
    if (factors.groups < 2 || factors.partial)
        return;
    const double groups = factors.groups;
    factors.outside_error = errors_of(counts.outside_shares(), groups);
    factors.sky_error = errors_of(counts.sky_shares(), groups);
    double area = 0, sky = 0, between = 0;
    for (std::size_t i = 0; i < factors.nodes.size(); ++i) {
        area += factors.nodes[i].area;
        sky += factors.nodes[i].area * factors.sky_error[i] * factors.sky_error[i];
        if (counts.exits()[i] == 0)
            continue;
        double of_sums = 0;
        for (std::uint64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
            of_sums += rows.value[k] * rows.value[k];
        // F_ij is Σ_g n_ijg / n_i: the variance of a sum of groups.
        const double variance =
            std::max(0.0, counts.squares()[i] - of_sums / groups) * groups / (groups - 1);
        const double exits = static_cast<double>(counts.exits()[i]);
        between += factors.nodes[i].area * variance / (exits * exits);
    }
    factors.rms_sky = std::sqrt(sky / area);
    factors.rms_factor = std::sqrt(between / area);
}

}  // namespace parallux
