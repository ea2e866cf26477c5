#include "error_bars/reference.h"

#include <cmath>

#include "support/statistics.h"

namespace parallux::error_bars {

namespace {

double over_dark(const Patches& patches, const std::function<double(std::size_t)>& value) {
    double sum = 0;
    for (std::size_t k = 0; k < patches.emission.size(); ++k)
        if (patches.emission[k] == 0)
            sum += patches.area[k / patches.bands] * value(k);
    return sum;
}

}  // namespace

Reference make_reference(const Place& place, SolveSettings settings, std::uint64_t bundles,
                         unsigned threads) {
    settings.target_error = 0;
    settings.bundles = bundles;
    settings.groups = 1 + reference_freedom / 2;
    const std::vector<Solution> runs = solve_seeds(place, settings, 2, 1'000'001, threads);
    Reference reference;
    std::size_t values = 0;
    for (std::size_t k = 0; k < runs[0].radiosity.size(); ++k) {
        const double a = runs[0].radiosity[k], b = runs[1].radiosity[k];
        const double spread = std::hypot(runs[0].stderror[k], runs[1].stderror[k]);
        reference.radiosity.push_back((a + b) / 2);
        reference.error.push_back(spread / 2);
        if (!reflects(place.patches, k) || spread == 0)
            continue;
        const double z = (a - b) / spread;
        reference.rms_z += z * z;
        reference.worst_z = std::max(reference.worst_z, std::fabs(z));
        ++values;
    }
    reference.rms_z = std::sqrt(reference.rms_z / static_cast<double>(values));
    reference.bound_z = test::sidak_bound(values, reference_freedom + 1);
    reference.power = over_dark(place.patches,
                                [&](std::size_t k) { return std::pow(reference.radiosity[k], 2); });
    return reference;
}

double relative_rms(const Place& place, const Reference& reference,
                    const std::vector<float>& radiosity) {
    return std::sqrt(over_dark(place.patches,
                               [&](std::size_t k) {
                                   return std::pow(radiosity[k] - reference.radiosity[k], 2);
                               }) /
                     reference.power);
}

}  // namespace parallux::error_bars
