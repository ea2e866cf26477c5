#pragma once

#include <cstddef>
#include <vector>

#include "efficiency/cases.h"

namespace parallux::efficiency {

/// Σ A_i x_i y_i / Σ A_i over the patches that do not emit, mean over bands; x(k) and y(k) give the
/// values of k = patch · bands + band. Linear.
template <typename X, typename Y>
double mean_product(const Case& of, const X& x, const Y& y) {
    const std::size_t bands = of.patches.bands;
    double sum = 0, weight = 0;
    for (std::size_t patch = 0; patch < of.weight.size(); ++patch) {
        if (of.weight[patch] == 0)
            continue;
        double products = 0;
        for (std::size_t k = patch * bands; k < (patch + 1) * bands; ++k)
            products += x(k) * y(k);
        sum += of.weight[patch] * products;
        weight += of.weight[patch] * static_cast<double>(bands);
    }
    return weight > 0 ? sum / weight : 0;
}

/// The same of x².
template <typename X>
double mean_square(const Case& of, const X& x) {
    return mean_product(of, x, x);
}

/// mean_square of a - b.
template <typename A, typename B>
double quadratic_error(const Case& of, const std::vector<A>& a, const std::vector<B>& b) {
    return mean_square(
        of, [&](std::size_t k) { return static_cast<double>(a[k]) - static_cast<double>(b[k]); });
}

}  // namespace parallux::efficiency
