#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "parallux/spectrum.h"

// Noise judged by numbers: bounds come from the sample's own spread and the number of comparisons.

namespace parallux::test {

/// Mean and standard error of a sample.
struct Sample {
    double sum = 0, squares = 0;
    int count = 0;

    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    double mean() const { return sum / count; }
    double variance() const {
        return std::max(0.0, (squares - sum * sum / count) / (count - 1));
    }
    double standard_error() const { return std::sqrt(variance() / count); }
    /// (mean - expected) in standard errors; 0 where both agree to rounding and nothing spreads.
    double z(double expected) const {
        double error = standard_error(), rounding = 1e-6 * std::fabs(expected);
        if (std::fabs(mean() - expected) <= rounding)
            return 0;
        return (mean() - expected) / std::max(error, 1e-300);
    }
};

/// Two-sided probability that Student's t with `freedom` degrees is beyond t, by Simpson's rule on
/// the density in the angle atan(t / √freedom), where it is a power of a cosine.
inline double student_tail(double t, int freedom) {
    double from = std::atan(std::fabs(t) / std::sqrt(double(freedom)));
    auto integral = [&](double a, double b) {
        constexpr int steps = 2000;
        double h = (b - a) / steps, sum = 0;
        for (int k = 0; k <= steps; ++k)
            sum += std::pow(std::cos(a + k * h), freedom - 1) * (k == 0 || k == steps ? 1 : k % 2 ? 4 : 2);
        return sum * h / 3;
    };
    return integral(from, pi / 2) / integral(0, pi / 2);
}

/// The bound that |t| of `comparisons` independent tests all stay below with probability 1 - level
/// (Šidák), for samples of `count`.
inline double sidak_bound(std::size_t comparisons, int count, double level = 1e-3) {
    double each = 1 - std::pow(1 - level, 1.0 / static_cast<double>(comparisons));
    double low = 0, high = 1e3;
    for (int k = 0; k < 60; ++k) {
        double middle = 0.5 * (low + high);
        (student_tail(middle, count - 1) > each ? low : high) = middle;
    }
    return high;
}

}  // namespace parallux::test
