#pragma once

#include <string>
#include <vector>

#include "efficiency/rounds.h"

namespace parallux::efficiency {

/// A relative RMS that someone wants, and what it takes.
struct Goal {
    std::string scene, method;
    double wanted = 0;
    double length = 0;        ///< bundles
    double seconds = 0;       ///< median
    double relative_rms = 0;  ///< reached at that length; of the forecast where not tried
    bool tried = false;       ///< false: foretold from the curve, because a run would take too long
    double reference_share = 0;
};

/// Searches the length at which a method's relative RMS is within 5 % of `wanted`, from the curve
/// of its rows on; runs that would take more than `longest` seconds are not tried.
Goal find_goal(const Case& of, const Reference& reference, const Contender& contender,
               const std::vector<Row>& rows, double wanted, double longest,
               const RoundSettings& settings);

}  // namespace parallux::efficiency
