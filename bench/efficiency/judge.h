#pragma once

#include "efficiency/rounds.h"

namespace parallux::efficiency {

/// Sets all that a row says of errors, from its runs and their quadratic errors. Two runs at least.
void judge(const Case& of, const Reference& reference, Row& row);

/// Whether a row's mean is farther from the reference than chance would have it.
inline bool is_off(const Row& row) {
    return row.mean_error > row.mean_bound;
}

/// Relative RMS of what chance and the reference's own error do not explain; 0: nothing.
double bias_of(const Row& row);

}  // namespace parallux::efficiency
