#pragma once

#include <cstdint>
#include <vector>

namespace parallux {

/// What the groups of a run tell of its error, and so of the error after more of them.
struct Foresight {
    double relative_rms = 0;      ///< of all that does not emit
    double alike = 1;             ///< patches that err as one: degrees of freedom of a group
    std::vector<double> lines{};  ///< of each group
    /// How fast a group's error falls with its lines: as lines^-fall. 0.6 with lattices of
    /// directions, which have more; 0.5 with random ones.
    double fall = 0.6;

    /// What the relative RMS is below with 95 % confidence; infinite from one group alone.
    double bound() const;
    /// What bound() is expected to be after so many more groups of so many lines each, weighed by
    /// their lines as Estimate weighs them. Linear in the groups.
    double bound_after(std::uint32_t groups, double lines_each) const;
};

/// A part of a run to a stated error.
struct Round {
    std::uint32_t groups = 0;  ///< 0: none is needed
    double length = 0;         ///< of each, in lengths of the last group
    double work() const { return groups * length; }
};

/// The least work that is expected to bring the bound below the target: groups as long as the last
/// one, and where so many as a round may have are not enough, longer ones; in all at most `most`
/// times the lines so far. Depends on the run's numbers alone, never on the time.
Round missing_round(const Foresight& so_far, double target, std::uint32_t most_groups, double most);

}  // namespace parallux
