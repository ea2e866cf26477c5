#include "solve/plan_lines.h"

#include <algorithm>
#include <cmath>

#include "parallux/error.h"

namespace parallux {

namespace {

// The last bundles only carry on what the others left. A bundle sends half of what is unshot (a
// quarter in one direction) and ρ of that comes back: so many that a fiftieth remains, but never
// more than an eighth of the run.
std::uint64_t closing_bundles(const Patches& patches, const SolveSettings& settings,
                              std::uint64_t bundles) {
    double area = 0, reflecting = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        float most = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band)
            most = std::max(most, patches.albedo(patch * patches.bands + band));
        area += patches.area[patch];
        reflecting += patches.area[patch] * most;
    }
    double sent = settings.direction == Direction::oriented ? 0.25 : 0.5;
    double kept = 1 - (1 - reflecting / area) * sent;
    // What is left over is followed along lines, but about so where walks go on from them.
    const double remains = patches.specular.empty() ? 0.02 : 0.002;
    double wanted = std::ceil(std::log(remains) / std::log(kept));
    return static_cast<std::uint64_t>(
        std::min(wanted, std::floor(static_cast<double>(bundles) / 8)));
}

// The pass only has to tell the gather roughly how bright everything is, because its error is
// smoothed by one more bounce: three tenths of the bundles, but 64 where those are half at most, so
// that the ways of what is left over are known.
std::uint64_t gathering_bundles(const SolveSettings& settings, std::uint64_t bundles) {
    const double all = static_cast<double>(bundles);
    if (settings.method != Method::bundles)
        return 0;
    if (settings.gather_share >= 0)
        return std::min(static_cast<std::uint64_t>(settings.gather_share * all), bundles - 1);
    if (bundles < 64)
        return 0;
    return static_cast<std::uint64_t>(all - std::max(0.3 * all, std::min(64.0, 0.5 * all)));
}

constexpr std::uint32_t usual_groups = 8;

// Groups whose spread tells the error of their mean: eight, if each has bundles enough to be
// without a bias of its own, which no spread would show.
std::uint32_t groups_of(const SolveSettings& settings, std::uint64_t bundles) {
    if (settings.method != Method::bundles)
        return 1;
    if (settings.groups > 0)
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(settings.groups, bundles));
    return bundles >= bundles_for_error && settings.gather_share != 0 ? usual_groups : 1;
}

bool follows_lines(const SolveSettings& settings) {
    return settings.method == Method::lines || settings.method == Method::matrix;
}

bool in_batches(const SolveSettings& settings) {
    return settings.method == Method::bundles ||
           (settings.method == Method::lines && settings.batch > 0);
}

// The area of a patch by which lines are spaced: of those that send the light on, where that is
// known and not far below the mean.
double typical_area(const Patches& patches, const Plan& plan) {
    const double mean = mean_area(patches);
    return plan.trial.lit_area > 0 ? std::clamp(plan.trial.lit_area, mean / 4, mean) : mean;
}

// Lines over a typical patch that suit so many bundles a group. The error of directions falls about
// as the square of their number, that of the lines' places as the number of lines: the finer the
// directions, the finer the lines. Lines are placed badly where what they meet changes between
// them: on patches with an outline of a surface over them, which in meshes of small surfaces are
// all, and there fewer than the usual number never pay. Elsewhere they do while a bundle's own work
// (its frame, its surfaces) takes as long as its lines.
double suitable_lines(const Patches& patches, const Plan& plan, double bundles) {
    constexpr double usual = 4, bundles_of_usual = 1500, most = 64;
    const double disc = pi * plan.sphere.radius * plan.sphere.radius;
    const double surfaces = static_cast<double>(patches.grids.size());
    const double outlined =
        std::min(1.0, 4 * std::sqrt(surfaces / static_cast<double>(patches.count())));
    const double cheap = (3000 + surfaces) * typical_area(patches, plan) / disc;
    const double fine = usual * std::pow(bundles / bundles_of_usual, 2.0 / 3);
    return std::clamp(std::max({fine, usual * outlined, std::min(usual, cheap)}), 1.0, most);
}

// The spacing, and with it the bundles that as many lines make as were asked for.
void plan_spacing(const Patches& patches, const SolveSettings& settings, Plan& plan) {
    const double disc = pi * plan.sphere.radius * plan.sphere.radius;
    auto bundles_of = [&] {
        if (settings.bundles)
            return static_cast<double>(settings.bundles);
        if (settings.lines)
            return std::max(1.0,
                            std::round(static_cast<double>(settings.lines) * plan.cell / disc));
        return settings.target_error > 0 ? 2.0 * bundles_for_error : 4096.0;
    };
    const bool fixed = settings.line_spacing > 0 || settings.lines_per_patch > 0;
    const double area = fixed ? mean_area(patches) : typical_area(patches, plan);
    double lines = settings.lines_per_patch > 0 ? settings.lines_per_patch : 4;
    // Of lines in all, fewer bundles are to have more each: three steps settle it well enough.
    const bool chosen = !fixed && settings.method == Method::bundles;
    for (int step = 0; step < (chosen ? 3 : 1); ++step) {
        plan.spacing = settings.line_spacing > 0 ? settings.line_spacing : std::sqrt(area / lines);
        plan.cell = plan.spacing * plan.spacing;
        const auto bundles = static_cast<std::uint64_t>(bundles_of());
        lines = suitable_lines(patches, plan,
                               static_cast<double>(bundles) / groups_of(settings, bundles));
    }
    if (chosen) {
        plan.spacing = std::sqrt(area / lines);
        plan.cell = plan.spacing * plan.spacing;
    }
    plan.bundles = static_cast<std::uint64_t>(bundles_of());
    if (settings.method == Method::bundles)
        check_spacing(plan.spacing, plan.sphere.radius);
}

// Bundles from one snapshot: as few as make merging some tenth of the work, and never so many that
// the light lags behind. At reflectance 0.8 and 30 000 bundles the error with 17 is 2.8 times that
// with one.
std::uint32_t suitable_batch(const Patches& patches, const Plan& plan) {
    const double merging = 13 * plan.cell / mean_area(patches);
    const double most = static_cast<double>(plan.passing()) / 128;
    return static_cast<std::uint32_t>(std::clamp(std::min(merging, most), 1.0, 64.0));
}

// A merge counts the exits of a batch in 32 bits.
constexpr double most_lines_a_batch = 1 << 30;

void limit_batch(double lines_a_bundle, Plan& plan) {
    if (lines_a_bundle > most_lines_a_batch)
        throw Error(Fault::usage, "more than 2^30 lines in a bundle; choose a larger spacing");
    plan.batch =
        std::min(plan.batch, static_cast<std::uint32_t>(most_lines_a_batch / lines_a_bundle));
}

}  // namespace

double mean_area(const Patches& patches) {
    double total = 0;
    for (double area : patches.area)
        total += area;
    return total / static_cast<double>(patches.count());
}

double too_small(const Patches& patches) {
    return mean_area(patches) / 16;
}

double mean_reflectance(const Patches& patches) {
    double area = 0, reflecting = 0;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        area += patches.area[k / patches.bands];
        reflecting += patches.area[k / patches.bands] * patches.albedo(k);
    }
    return reflecting / area;
}

void plan_lines(const Patches& patches, const SolveSettings& settings, Plan& plan) {
    double disc = pi * plan.sphere.radius * plan.sphere.radius;
    plan_spacing(patches, settings, plan);
    // A bundle's lines through the sphere, and so the independent lines that stand for it.
    double lines_a_bundle = disc / plan.cell;
    if (follows_lines(settings)) {
        plan.lines_a_unit = static_cast<std::uint64_t>(std::max(1.0, std::round(lines_a_bundle)));
        plan.lines = settings.lines ? settings.lines : plan.bundles * plan.lines_a_unit;
        plan.lines_a_unit = std::min(plan.lines_a_unit, plan.lines);
        plan.bundles = (plan.lines - 1) / plan.lines_a_unit + 1;
        plan.cell = disc / static_cast<double>(plan.lines_a_unit);
    }
    plan.groups = groups_of(settings, plan.bundles);
    plan.too_few = settings.method == Method::bundles && settings.groups == 0 &&
                   plan.bundles < bundles_for_error;
    plan.bundles = (plan.bundles - 1) / plan.groups + 1;
    plan.gathering = gathering_bundles(settings, plan.bundles);
    if (in_batches(settings))
        plan.closing = closing_bundles(patches, settings, plan.passing());
    std::uint64_t emitting = plan.passing() - plan.closing;
    if (follows_lines(settings)) {
        // n_i = N A_i / (2 π R²) exits, so that an exit carries 2 π R² E / N.
        std::uint64_t lines = std::min(plan.lines, emitting * plan.lines_a_unit);
        plan.emission_cell = 2 * disc / static_cast<double>(lines);
    } else {
        // n_i = D A_i / (2 δ²) exits, so that an exit carries 2 δ² E / D.
        plan.emission_cell = 2 * plan.cell / static_cast<double>(emitting);
    }
    if (settings.direction == Direction::oriented)
        plan.emission_cell *= 2;
    plan.batch = settings.batch;
    if (settings.method == Method::bundles && settings.batch == 0)
        plan.batch = suitable_batch(patches, plan);
    if (plan.batch > 0)
        limit_batch(disc / plan.cell, plan);
    const double half_exits =
        mean_area(patches) * static_cast<double>(patches.count()) / (4 * plan.cell);
    plan.keeping = keeping_of(patches.count(), half_exits, plan.passing());
}

}  // namespace parallux
