#include "efficiency/goals.h"

#include <algorithm>
#include <cmath>

#include "efficiency/gains.h"

namespace parallux::efficiency {

namespace {

constexpr int most_tries = 6;
constexpr double near = 0.05;  // a goal is met where the error is so close to it

double length_of(const Row& row) {
    return static_cast<double>(row.length);
}

}  // namespace

Goal find_goal(const Case& of, const Reference& reference, const Contender& contender,
               const std::vector<Row>& rows, double wanted, double longest,
               const RoundSettings& settings) {
    const std::vector<const Row*> curve = rows_of(rows, contender.name);
    // Foretell it from the curve's last two lengths, or the first two where it lies before them.
    std::vector<const Row*> part = curve;
    if (part.size() > 2)
        part = curve[1]->relative_rms < wanted
                   ? std::vector<const Row*>{curve.begin(), curve.begin() + 2}
                   : std::vector<const Row*>{curve.end() - 2, curve.end()};
    Power error = fit(part, length_of, [](const Row& row) { return row.relative_rms; });
    const Power seconds = fit(part, length_of, [](const Row& row) { return row.seconds; });
    error.slope = std::clamp(error.slope, -1.25, -0.6);
    const Row& last = *part.back();

    Goal goal;
    goal.scene = of.name;
    goal.method = contender.name;
    goal.wanted = wanted;
    goal.length = length_of(last);
    goal.relative_rms = last.relative_rms;
    for (int k = 0; k < most_tries; ++k) {
        // The error falls as length^slope: go where it should be as wanted.
        goal.length = std::max(
            1.0, std::round(goal.length * std::pow(wanted / goal.relative_rms, 1 / error.slope)));
        goal.seconds = seconds(goal.length);
        goal.tried = goal.seconds <= longest;
        if (!goal.tried) {
            goal.relative_rms = wanted;
            break;
        }
        const Row row =
            run_row(of, reference, contender, static_cast<std::uint64_t>(goal.length), settings);
        goal.seconds = row.seconds;
        goal.relative_rms = row.relative_rms;
        goal.reference_share = row.reference_share;
        if (std::fabs(goal.relative_rms / wanted - 1) < near || goal.length <= 1)
            break;
    }
    return goal;
}

}  // namespace parallux::efficiency
