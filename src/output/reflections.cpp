#include "output/reflections.h"

#include <algorithm>
#include <utility>

namespace parallux {

// Mirrors or is glass all over, and emits nothing.
bool Reflections::is_dark(std::uint32_t patch) const {
    const Patches& patches = walks_.patches;
    const float* emission = &patches.emission[std::size_t(patch) * patches.bands];
    return patches.specular_share(patch) == 1 &&
           std::all_of(emission, emission + patches.bands, [](float e) { return e == 0; });
}

void Reflections::add(const glm::dvec3& direction, const SurfaceHit& hit, const Radiance& of_patch,
                      Random& random, Spectrum& radiance) const {
    const Scene& scene = walks_.scene;
    const Surface& surface = scene.surfaces[hit.surface];
    const std::uint32_t bands = scene.bands;
    const int walks = walks_.rough(surface.material) ? 32 : 8;
    // Past backs that are seen through.
    const glm::dvec3 before =
        surface_point(scene, surface, hit.u, hit.v) - 1e-3 * double(hit.t) * direction;
    auto add_seen = [&](const Spectrum& seen, const Weights& weights) {
        for (std::uint32_t b = 0; b < bands; ++b)
            radiance[b] += static_cast<float>(weights[b] * seen[b]);
    };
    bool first = true;
    auto visit = [&](const Walk& walk, const Weights& weights) {
        if (!std::exchange(first, false) && !is_dark(walk.patch()))
            add_seen(of_patch(walk.hit(), walk.patch()), weights);
    };
    auto sky = [&](const glm::dvec3& out, const Weights& weights) {
        if (scene.sky.kind != Sky::Kind::dark)
            add_seen(scene.sky.radiance(out), weights);
    };
    Weights weights;
    weights.fill(1.0 / walks);
    for (int k = 0; k < walks; ++k, first = true)
        follow_sight(Walk(walks_, before, direction), weights, bands, random, visit, sky);
}

}  // namespace parallux
