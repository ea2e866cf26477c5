#pragma once

#include <cstddef>
#include <vector>

#include "efficiency/cases.h"

namespace parallux::efficiency {

/// Σ A_i x_i² / Σ A_i over the patches that do not emit, mean over bands; value(k) gives x of
/// k = patch · bands + band. Linear.
template <typename Value>
double mean_square(const Case& of, const Value& value) {
    const std::size_t bands = of.patches.bands;
    double sum = 0, weight = 0;
    for (std::size_t patch = 0; patch < of.weight.size(); ++patch) {
        if (of.weight[patch] == 0)
            continue;
        double squares = 0;
        for (std::size_t k = patch * bands; k < (patch + 1) * bands; ++k)
            squares += value(k) * value(k);
        sum += of.weight[patch] * squares;
        weight += of.weight[patch] * static_cast<double>(bands);
    }
    return weight > 0 ? sum / weight : 0;
}

/// mean_square of a - b.
template <typename A, typename B>
double quadratic_error(const Case& of, const std::vector<A>& a, const std::vector<B>& b) {
    return mean_square(
        of, [&](std::size_t k) { return static_cast<double>(a[k]) - static_cast<double>(b[k]); });
}

}  // namespace parallux::efficiency
