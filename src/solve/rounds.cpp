#include "solve/rounds.h"
#include "solve/plan_shots.h"

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
    Plan plan = make_plan(scene_, patches_, own);
    plan.groups = round.groups;
    if (last.try_rays)
        set_rays(patches_, last.ray_variance, plan);
    return plan;
}

bool Rounds::another(const Estimate& estimate, const Seconds& seconds, Listener& listener,
                     Plan& plan) {
    const double target = settings_.target_error;
    if (target <= 0 || ++done_ == most_rounds)
        return false;
    Foresight known = estimate.foresight();
    if (settings_.directions == DirectionSet::random)
        known.fall = 0.5;
    if (known.bound() <= target)
        return false;
    listener.tell(forecast_of(known, target, estimate, seconds, first_.groups, plan));
    plan = planned(missing_round(known, target, first_.groups, most_growth), plan);
    return true;
}

}  // namespace parallux
