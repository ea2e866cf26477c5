#pragma once

#include "solve/estimate.h"
#include "solve/foresight.h"
#include "solve/run.h"

namespace parallux {

/// The rounds of a run to a stated error; of other runs, the only one.
class Rounds {
public:
    /// `first` is the plan of the first round. Keeps references to the others.
    Rounds(const Scene& scene, const Patches& patches, const SolveSettings& settings,
           const Plan& first)
        : scene_(scene), patches_(patches), settings_(settings), first_(first) {}

    /// After a round: false when the error is known to be small enough, was not asked for, or this
    /// was the last round. Else tells what is missing and sets the plan of the next round: groups
    /// of the same quanta as those before, whose rays grow with their bundles.
    bool another(const Estimate& estimate, const Seconds& seconds, Listener& listener, Plan& plan);

    /// Groups of the rounds before this one.
    std::uint32_t groups_before() const;
    /// What another run needs to set its plan as this one has: the rounds, to be read or written,
    /// and from then on the plan of the first round becomes that of the last.
    template <class Archive>
    void fields(Archive& a) {
        a(further_);
    }
    void replay(Plan& plan) const;
    /// False for rounds that no run comes to.
    bool sound() const;

private:
    Plan planned(const Round& round, const Plan& last) const;

    const Scene& scene_;
    const Patches& patches_;
    const SolveSettings& settings_;
    const Plan first_;
    std::vector<Round> further_;  // after the first
};

}  // namespace parallux
