#include "efficiency/check.h"

#include <cmath>
#include <cstdio>

#include "efficiency/gains.h"

namespace parallux::efficiency {

namespace {

// Methods are allowed so much systematic error, relative: the end of a run is an estimate, and
// shots stop at a thousandth of the power.
constexpr double allowed_bias = 0.003;

bool says(bool good, const char* what, double found, double allowed) {
    std::printf("  %-46s %10.4g  allowed %10.4g  %s\n", what, found, allowed,
                good ? "ok" : "WRONG");
    return good;
}

}  // namespace

bool methods_agree(const Reference& reference, const std::vector<Row>& rows) {
    std::printf("relative RMS of each method's mean, against the reference:\n");
    bool good = says(reference.rays.agrees(), "the reference's runs without shot and by rays",
                     reference.rays.difference, reference.rays.bound);
    for (const Row& row : rows) {
        if (&row != rows_of(rows, row.method).back())
            continue;
        const double found = std::sqrt(row.mean_error / reference.scale);
        const double allowed = std::sqrt(row.mean_bound / reference.scale) + allowed_bias;
        good &= says(found <= allowed, row.method.c_str(), found, allowed);
    }
    return good;
}

}  // namespace parallux::efficiency
