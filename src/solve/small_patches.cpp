#include "solve/small_patches.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lines/periodic.h"
#include "solve/emitters.h"
#include "solve/plan_lines.h"

namespace parallux {

std::vector<std::uint32_t> numbers_of(const std::vector<SmallPatch>& small) {
    std::vector<std::uint32_t> numbers;
    for (const SmallPatch& one : small)
        numbers.push_back(one.patch);
    return numbers;
}

double sent_by_exit(const Run& run, const Emission& emission, const PassResult& pass,
                    std::size_t k) {
    return emission.of_exit(run.patches, k) +
           scattered(run.patches, k, [&](std::size_t at) { return pass.irradiance[at]; });
}

namespace {

constexpr double few_lines = 32;

std::string few_lines_warning(const Run& run, std::uint32_t first, std::size_t count,
                              std::size_t served) {
    const std::uint32_t surface =
        patch_places(run.scene, run.patches, first, first + 1).front().surface;
    std::string text = std::to_string(count) +
                       " patches (first: " + run.scene.objects[run.scene.surfaces[surface].object] +
                       ") are so small that fewer than 32 lines of a group leave each; ";
    if (served > 0)
        text += (served == count
                     ? "local rays serve them"
                     : "local rays serve the " + std::to_string(served) + " that matter most");
    else
        text += "a smaller --line-spacing or more --bundles would serve them better";
    return text;
}

// Whether another surface lies in the very place of a patch, or closer than lines can part them.
bool is_covered(const Run& run, const PatchCells& cells, std::size_t k) {
    constexpr int places = 8;
    std::vector<SurfaceHit> hits;
    const double near = 1e-5 * run.plan.sphere.radius;
    for (int place = 0; place < places; ++place) {
        const double a = (place + 0.5) / places, b = std::fmod(place * 0.375 + 0.0625, 1.0);
        const Emitter& cell = cells.choose(k, a);
        const glm::dvec3 point = point_on(run.scene, cell, a, b);
        const glm::dvec3 up = near * emitter_normal(run.scene, cell);
        run.rays->all(point - up, 2.0 * up, 1, hits);
        if (std::any_of(hits.begin(), hits.end(),
                        [&](const SurfaceHit& hit) { return hit.surface != cell.surface; }))
            return true;
    }
    return false;
}

void leave_out_covered(const Run& run, std::vector<SmallPatch>& small) {
    const PatchCells cells(run.scene, run.patches, numbers_of(small));
    std::vector<SmallPatch> kept;
    for (std::size_t k = 0; k < small.size(); ++k)
        if (!is_covered(run, cells, k))
            kept.push_back(small[k]);
    small = std::move(kept);
}

// Both sides of what lets light through are served, or none: what one has found the other sends.
void leave_out_single_sides(const Patches& patches, std::vector<SmallPatch>& small) {
    const std::vector<std::uint32_t> numbers = numbers_of(small);
    std::erase_if(small, [&](const SmallPatch& one) {
        const std::uint32_t side = patches.other[one.patch];
        return side != none && !std::binary_search(numbers.begin(), numbers.end(), side);
    });
}

}  // namespace

std::vector<SmallPatch> small_patches(const Run& run, const TransferState& state,
                                      PassResult& pass) {
    const Plan& plan = run.plan;
    const Patches& patches = run.patches;
    // Local paths know nothing of a scene's copies, nor of mirrors.
    if (!run.rays || run.walks || plan.gathering == 0 || !pass.whole || is_periodic(run.scene))
        return {};
    const double lines_a_bundle = pi * plan.sphere.radius * plan.sphere.radius / plan.cell;
    const auto most =
        static_cast<std::size_t>(3e-4 * lines_a_bundle * static_cast<double>(plan.bundles));
    const double below = too_small(patches);
    const double exits_an_area = static_cast<double>(plan.gathering) / (2 * plan.cell);
    Emission emission = state.emission;
    emission.quanta = 1;
    struct Found {
        double weight;
        std::uint32_t patch;
    };
    std::vector<Found> found;
    double power = 0, all = 0, brightest = 0;
    for (std::uint32_t patch = 0; patch < patches.count(); ++patch) {
        const double area = patches.area[patch], exits = area * exits_an_area;
        double square = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band)
            square += std::pow(
                sent_by_exit(run, emission, pass, patch * std::size_t(patches.bands) + band), 2);
        if (area < below && exits < few_lines) {
            found.push_back({area * square / (exits + 1), patch});
            brightest = std::max(brightest, square);
        } else {
            power += area * square;
        }
        all += area;
    }
    // Where all are as bright as others, lines do as well, and exactly so where light is uniform.
    constexpr double bright = 4;
    const bool serve = brightest * all > bright * bright * power;
    if (!found.empty())
        pass.warnings.push_back(few_lines_warning(run, found.front().patch, found.size(),
                                                  serve ? std::min(most, found.size()) : 0));
    if (!serve)
        return {};
    if (found.size() > most) {
        std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(most),
                         found.end(), [](const Found& a, const Found& b) {
                             return a.weight != b.weight ? a.weight > b.weight : a.patch < b.patch;
                         });
        found.resize(most);
    }
    std::vector<SmallPatch> chosen;
    for (const Found& one : found)
        chosen.push_back({one.patch});
    std::sort(chosen.begin(), chosen.end(),
              [](const SmallPatch& a, const SmallPatch& b) { return a.patch < b.patch; });
    if (!chosen.empty())
        leave_out_covered(run, chosen);
    if (patches.translucent())
        leave_out_single_sides(patches, chosen);
    return chosen;
}

}  // namespace parallux
