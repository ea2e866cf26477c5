#pragma once

#include "solve/estimate.h"
#include "solve/run.h"

namespace parallux {

/// Shows the caller between groups what those so far come to, when it is time again.
class Showing {
public:
    explicit Showing(const Preview& preview) : preview_(preview) {}

    void between_groups(const Estimate& estimate, const Plan& plan, const Seconds& seconds) {
        if (!preview_.show || estimate.groups() == 0 || watch_.seconds() < preview_.every)
            return;
        Solution solution = Estimate(estimate).solution(plan);
        solution.seconds = seconds;
        solution.partial = true;
        preview_.show(solution);
        watch_ = Watch();
    }

private:
    const Preview& preview_;
    Watch watch_;  // since the run began, or the last one was shown
};

}  // namespace parallux
