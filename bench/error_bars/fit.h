#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace parallux::error_bars {

/// Runs of one length.
struct Point {
    std::uint64_t bundles = 0;
    std::uint32_t groups = 1;
    double lines = 0;
    double error = 0;   ///< mean quadratic error
    double spread = 0;  ///< standard error of that mean, relative
};

struct Fit {
    double slope = 0;
    double error = 0;  ///< standard error of the slope, from the points' own
};

/// Least squares of log error against log lines, all points alike.
inline Fit fit_line(const std::vector<Point>& points) {
    double mean = 0, squares = 0;
    for (const Point& point : points)
        mean += std::log(point.lines) / static_cast<double>(points.size());
    for (const Point& point : points)
        squares += std::pow(std::log(point.lines) - mean, 2);
    Fit fit;
    double variance = 0;
    for (const Point& point : points) {
        const double weight = (std::log(point.lines) - mean) / squares;
        fit.slope += weight * std::log(point.error);
        variance += std::pow(weight * point.spread, 2);
    }
    fit.error = std::sqrt(variance);
    return fit;
}

inline Fit fit_between(const Point& a, const Point& b) {
    return fit_line({a, b});
}

}  // namespace parallux::error_bars
