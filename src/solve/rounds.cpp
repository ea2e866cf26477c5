#include "solve/rounds.h"

#include <algorithm>
#include <cmath>

namespace parallux {

namespace {

// A round does so many times the lines before it at most, because a forecast from few is rough.
constexpr double most_growth = 16;
constexpr double most_foreseen = 1e12;

std::uint64_t bundles_a_group(const Round& round, const Plan& last) {
    return static_cast<std::uint64_t>(std::ceil(round.length * static_cast<double>(last.bundles)));
}

// What is missing in all, and the time for it: direct light that all groups share is not found
// again, other takes part in the pace.
Forecast forecast_of(const Foresight& known, double target, const Estimate& estimate,
                     const Seconds& seconds, std::uint32_t most_groups, const Plan& last) {
    const Round rest = missing_round(known, target, most_groups, most_foreseen);
    Forecast forecast;
    forecast.error = known.bound();
    forecast.target = target;
    forecast.bundles = rest.groups * bundles_a_group(rest, last);
    const double spent =
        seconds.global + seconds.gather + (last.shoot_each ? seconds.first_shot : 0);
    forecast.seconds =
        spent * static_cast<double>(forecast.bundles) / static_cast<double>(estimate.bundles());
    return forecast;
}

}  // namespace

Plan Rounds::planned(const Round& round, const Plan& last) const {
    SolveSettings own = settings_;
    own.groups = first_.groups;
    own.first_shot = first_.first_shot;
    own.bundles = first_.groups * bundles_a_group(round, last);
    const double growth =
        static_cast<double>(own.bundles) / static_cast<double>(first_.groups * first_.bundles);
    own.first_shot_rays = static_cast<std::uint64_t>(
        std::llround(growth * static_cast<double>(settings_.first_shot_rays)));
    Plan plan = make_plan(scene_, patches_, own, last.trial);
    plan.groups = round.groups;
    return plan;
}

bool Rounds::another(const Estimate& estimate, const Seconds& seconds, Listener& listener,
                     Plan& plan) {
    const double target = settings_.target_error;
    if (target <= 0 || further_.size() + 1 == most_rounds)
        return false;
    Foresight known = estimate.foresight();
    if (settings_.directions == DirectionSet::random)
        known.fall = 0.5;
    if (known.bound() <= target)
        return false;
    listener.tell(forecast_of(known, target, estimate, seconds, first_.groups, plan));
    further_.push_back(missing_round(known, target, first_.groups, most_growth));
    plan = planned(further_.back(), plan);
    return true;
}

std::uint32_t Rounds::groups_before() const {
    std::uint32_t groups = further_.empty() ? 0 : first_.groups;
    for (std::size_t round = 0; round + 1 < further_.size(); ++round)
        groups += further_[round].groups;
    return groups;
}

void Rounds::replay(Plan& plan) const {
    for (const Round& round : further_)
        plan = planned(round, plan);
}

bool Rounds::sound() const {
    return further_.size() < most_rounds &&
           std::all_of(further_.begin(), further_.end(), [&](const Round& round) {
               return round.groups >= 1 && round.groups <= first_.groups && round.length > 0 &&
                      round.length * round.groups <= 1e6;
           });
}

}  // namespace parallux
