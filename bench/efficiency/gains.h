#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "efficiency/rounds.h"

namespace parallux::efficiency {

/// The rows of one method, by length.
std::vector<const Row*> rows_of(const std::vector<Row>& rows, const std::string& method);

/// Sets the gain of every row of one case: quadratic error × time of the baseline over that of the
/// row. The baseline's is taken at the row's time, between its two lengths about it (along a
/// straight line in logarithms) or at the nearest of its lengths where there are no two.
void set_gains(std::vector<Row>& rows);

/// y = at_one · x^slope.
struct Power {
    double at_one = 0, slope = 0;

    double operator()(double x) const { return at_one * std::pow(x, slope); }
};

/// The power that fits y(row) against x(row) best in logarithms, by least squares. Two rows at
/// least, of different x.
template <typename X, typename Y>
Power fit(const std::vector<const Row*>& rows, const X& x, const Y& y) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Row* row : rows) {
        const double lx = std::log(x(*row)), ly = std::log(y(*row));
        n += 1;
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    return {std::exp((sy - slope * sx) / n), slope};
}

}  // namespace parallux::efficiency
