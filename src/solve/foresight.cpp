#include "solve/foresight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace parallux {

namespace {

// What the ratio of two mean squares of so many degrees of freedom stays below with 95 %
// (E. Paulson, 1942, after Wilson and Hilferty).
double f_bound(double above, double below) {
    constexpr double z = 1.6448536;
    const double a = 2 / (9 * above), b = 2 / (9 * below);
    const double root = std::sqrt((1 - b) * (1 - b) * a + (1 - a) * (1 - a) * b - z * z * a * b);
    return std::pow(((1 - a) * (1 - b) + z * root) / ((1 - b) * (1 - b) - z * z * b), 3);
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double Foresight::bound() const {
    if (lines.size() < 2)
        return std::numeric_limits<double>::infinity();
    const double others = static_cast<double>(lines.size()) - 1;
    return relative_rms * std::sqrt(f_bound(alike, alike * others));
}

double Foresight::bound_after(std::uint32_t groups, double lines_each) const {
    // Variance of the mean: Σ n² n^(-2 fall) / (Σ n)².
    auto part = [&](double n) { return std::pow(n, 2 - 2 * fall); };
    double parts = 0;
    for (double n : lines)
        parts += part(n);
    const double all = sum(lines);
    const double more = 1 + groups * part(lines_each) / parts;
    const double weight = 1 + groups * lines_each / all;
    const double others = static_cast<double>(lines.size() + groups) - 1;
    return relative_rms * std::sqrt(more) / weight * std::sqrt(f_bound(alike, alike * others));
}

Round missing_round(const Foresight& so_far, double target, std::uint32_t most_groups,
                    double most) {
    if (so_far.bound() <= target)
        return {};
    const double last = so_far.lines.back();
    auto enough = [&](const Round& round) {
        return so_far.bound_after(round.groups, round.length * last) <= target;
    };
    for (std::uint32_t groups = 1; groups <= most_groups; ++groups)
        if (enough({groups, 1}))
            return {groups, 1};
    // Halve the interval of lengths down to a hundredth.
    double low = 1, high = std::max(1.0, most * sum(so_far.lines) / (most_groups * last));
    while (high > 1.01 * low) {
        const double middle = std::sqrt(low * high);
        (enough({most_groups, middle}) ? high : low) = middle;
    }
    return {most_groups, high};
}

}  // namespace parallux
