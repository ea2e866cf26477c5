#include "view_factors/plan.h"

#include <algorithm>
#include <cmath>

#include "parallux/lines.h"
#include "solve/plan_lines.h"

namespace parallux {

std::uint32_t choose_groups(const FactorSettings& settings) {
    const std::uint32_t wanted = settings.groups ? settings.groups : settings.bundles >= 64 ? 8 : 1;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, settings.bundles));
}

double choose_spacing(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                      std::uint32_t groups) {
    // Below so many lines a bundle is not worth its projection.
    constexpr double least_lines_a_bundle = 16384;
    if (settings.line_spacing > 0)
        return settings.line_spacing;
    if (settings.lines_per_patch > 0)
        return std::sqrt(mean_area(patches) / settings.lines_per_patch);
    const double a_group = static_cast<double>(settings.bundles) / groups;
    const double lines_a_patch = std::clamp(8 * std::cbrt(a_group / 128), 4.0, 64.0);
    const double radius = line_sphere(scene).radius;
    return std::sqrt(
        std::min(mean_area(patches) / lines_a_patch, pi * radius * radius / least_lines_a_bundle));
}

}  // namespace parallux
