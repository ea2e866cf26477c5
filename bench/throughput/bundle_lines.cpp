#include "throughput/bundle_lines.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/edge_walk.h"

namespace parallux::throughput {

LineRectangle rectangle_of(const Scene& scene, const glm::dvec3& centre, const Bundle& bundle) {
    const glm::dvec3 x = bundle.x * (1 / bundle.spacing), y = bundle.y * (1 / bundle.spacing);
    double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
    for (const glm::dvec3& position : scene.positions) {
        const glm::dvec3 from_centre = position - centre;
        const double px = glm::dot(from_centre, x), py = glm::dot(from_centre, y);
        left = std::min(left, px);
        right = std::max(right, px);
        top = std::min(top, py);
        bottom = std::max(bottom, py);
    }
    auto first = [](double place, double offset) {
        return first_line(std::lrint((place + offset) * fixed_one));
    };
    LineRectangle lines;
    lines.left = first(left, bundle.offset_x);
    lines.top = first(top, bundle.offset_y);
    lines.columns = std::max(0, first(right, bundle.offset_x) - lines.left);
    lines.rows = std::max(0, first(bottom, bundle.offset_y) - lines.top);
    return lines;
}

double mean_rectangle(const Scene& scene, std::uint64_t bundles) {
    const LineSphere sphere = line_sphere(scene);
    const std::uint64_t count = std::min<std::uint64_t>(bundles, 64);
    // So fine that the rounding to whole lines does not matter.
    BundleSettings settings;
    settings.count = bundles;
    settings.spacing = sphere.radius / 10'000;
    double sum = 0;
    for (std::uint64_t k = 0; k < count; ++k)
        sum += static_cast<double>(
            rectangle_of(scene, sphere.centre, make_bundle(settings, k)).lines());
    return sum / static_cast<double>(count) * settings.spacing * settings.spacing;
}

}  // namespace parallux::throughput
