#include "efficiency/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "efficiency/gains.h"

namespace parallux::efficiency {

namespace {

// What mean_error / mean_expected of R runs stays below with 99.9 % confidence. Were all patches to
// err as one it would be Student's t² of R - 1 degrees of freedom, which is the worst case: patches
// that err each for itself average out.
double bound_of(std::size_t runs) {
    constexpr double t[] = {636.6, 31.6, 12.92, 8.61, 6.87, 5.96, 5.41, 5.04, 4.78, 4.59};
    const std::size_t freedom = std::min<std::size_t>(runs - 1, 10);
    return t[freedom - 1] * t[freedom - 1];
}

// Methods are allowed so much systematic error, relative: the end of a run is an estimate, and
// shots stop at a thousandth of the power.
constexpr double allowed_bias = 0.003;

bool says(bool good, const char* what, double found, double allowed) {
    std::printf("  %-40s %10.4g  allowed %10.4g  %s\n", what, found, allowed,
                good ? "ok" : "WRONG");
    return good;
}

}  // namespace

bool methods_agree(const Reference& reference, const std::vector<Row>& rows) {
    std::printf("relative RMS of each method's mean, against the reference:\n");
    bool good =
        says(reference.agrees(), "the reference's two runs", reference.difference, reference.bound);
    for (const Row& row : rows) {
        if (&row != rows_of(rows, row.method).back())
            continue;
        const double found = std::sqrt(row.mean_error / reference.scale);
        const double chance =
            std::sqrt(bound_of(row.errors.size()) * row.mean_expected / reference.scale);
        const double allowed = std::hypot(chance, allowed_bias);
        good &= says(found <= allowed, row.method.c_str(), found, allowed);
    }
    return good;
}

}  // namespace parallux::efficiency
