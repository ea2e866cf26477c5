#pragma once

#include "error_bars/seeds.h"

namespace parallux::error_bars {

/// What runs are judged against: the mean of two far longer runs.
struct Reference {
    std::vector<double> radiosity;
    std::vector<double> error;      ///< standard error of each, from the runs' own groups
    double rms_z = 0, worst_z = 0;  ///< of the differences of the two
    double bound_z = 0;             ///< Šidák
    double power = 0;  ///< Σ A B² of all that does not emit: the square of a relative RMS of 1

    bool agree() const { return worst_z < bound_z; }
};

/// Two runs of so many bundles, at once where there are threads for it.
Reference make_reference(const Place& place, SolveSettings settings, std::uint64_t bundles,
                         unsigned threads);

/// Degrees of freedom of a reference's standard errors: two runs of eight groups.
inline constexpr int reference_freedom = 14;

/// Whether a value has an error at all: black patches only emit.
inline bool reflects(const Patches& patches, std::size_t k) {
    return patches.reflectance[k] > 0;
}

/// Quadratic error of a run over all that does not emit, as a relative RMS.
double relative_rms(const Place& place, const Reference& reference,
                    const std::vector<float>& radiosity);

}  // namespace parallux::error_bars
