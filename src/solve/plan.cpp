#include "solve/plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <unistd.h>

#include "parallel.h"
#include "parallux/error.h"
#include "reference/matrix.h"
#include "solve/emitters.h"
#include "transfer/banks.h"
#include "transfer/partition.h"

namespace parallux {

namespace {

double mean_area(const Patches& patches) {
    double total = 0;
    for (double area : patches.area)
        total += area;
    return total / static_cast<double>(patches.count());
}

bool emits(const Patches& patches) {
    return std::any_of(patches.emission.begin(), patches.emission.end(),
                       [](float e) { return e > 0; });
}

// Power that could enter or be emitted, per band, from above.
double power_bound(const Scene& scene, const Patches& patches, const LineSphere& sphere) {
    double most = 0;
    double disc = pi * sphere.radius * sphere.radius;
    double sky = 0;
    if (scene.sky.kind != Sky::Kind::dark)
        for (std::uint32_t band = 0; band < scene.bands; ++band)
            sky = std::max(sky, sky_bound(scene.sky, band) * pi * 4 * disc);
    for (std::uint32_t band = 0; band < patches.bands; ++band) {
        double watts = sky;
        for (std::size_t patch = 0; patch < patches.count(); ++patch)
            watts += patches.area[patch] * patches.emission[patch * patches.bands + band];
        for (const Light& light : scene.lights)
            watts +=
                light.intensity[band] * (light.kind == Light::Kind::directional ? disc : 4 * pi);
        most = std::max(most, watts);
    }
    return most;
}

// A power of two, so that scaling the light or the scene by one changes no bit of the result. All
// that ever flows, at most P / (1 - ρ), fits 2⁶⁰ quanta.
double quantum(double power, double highest_reflectance) {
    if (power <= 0)
        return 1;
    int exponent = 0;
    std::frexp(power / (1 - highest_reflectance), &exponent);
    return std::ldexp(1.0, exponent - 60);
}

// The last bundles only carry on what the others left. A bundle sends half of what is unshot (a
// quarter in one direction) and ρ of that comes back: so many that a fiftieth remains, but never
// more than an eighth of the run.
std::uint64_t closing_bundles(const Patches& patches, const SolveSettings& settings,
                              std::uint64_t bundles) {
    double area = 0, reflecting = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        float most = 0;
        for (std::uint32_t band = 0; band < patches.bands; ++band)
            most = std::max(most, patches.reflectance[patch * patches.bands + band]);
        area += patches.area[patch];
        reflecting += patches.area[patch] * most;
    }
    double sent = settings.direction == Direction::oriented ? 0.25 : 0.5;
    double kept = 1 - (1 - reflecting / area) * sent;
    double wanted = std::ceil(std::log(0.02) / std::log(kept));
    return static_cast<std::uint64_t>(
        std::min(wanted, std::floor(static_cast<double>(bundles) / 8)));
}

double mean_reflectance(const Patches& patches) {
    double area = 0, reflecting = 0;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        area += patches.area[k / patches.bands];
        reflecting += patches.area[k / patches.bands] * patches.reflectance[k];
    }
    return reflecting / area;
}

// The pass only has to tell the gather roughly how bright everything is, because its error is
// smoothed by one more bounce: three tenths of the bundles, but as many as the bounces need.
std::uint64_t gathering_bundles(const Patches& patches, const SolveSettings& settings,
                                std::uint64_t bundles) {
    const double all = static_cast<double>(bundles);
    if (settings.method != Method::bundles)
        return 0;
    if (settings.gather_share >= 0)
        return std::min(static_cast<std::uint64_t>(settings.gather_share * all), bundles - 1);
    if (bundles < 64)
        return 0;
    const double bounces = 100 / (1 - mean_reflectance(patches));
    return static_cast<std::uint64_t>(all - std::min(std::max(0.3 * all, bounces), 0.5 * all));
}

// Groups whose spread tells the error of their mean: eight, if each has bundles enough to be
// without a bias of its own, which no spread would show.
std::uint32_t groups_of(const Patches& patches, const SolveSettings& settings,
                        std::uint64_t bundles) {
    constexpr std::uint32_t usual = 8;
    if (settings.method != Method::bundles)
        return 1;
    if (settings.groups > 0)
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(settings.groups, bundles));
    const double enough = usual * 80 / (1 - mean_reflectance(patches));
    return static_cast<double>(bundles) >= enough && settings.gather_share != 0 ? usual : 1;
}

// The first round of a run to a stated error: enough for groups without bias.
std::uint64_t trial_bundles(const Patches& patches) {
    return static_cast<std::uint64_t>(std::ceil(640 / (1 - mean_reflectance(patches))));
}

bool follows_lines(const SolveSettings& settings) {
    return settings.method == Method::lines || settings.method == Method::matrix;
}

bool in_batches(const SolveSettings& settings) {
    return settings.method == Method::bundles ||
           (settings.method == Method::lines && settings.batch > 0);
}

std::uint64_t machine_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

// A merge counts the exits of a batch in 32 bits.
constexpr double most_lines_a_batch = 1 << 30;

void limit_batch(double lines_a_bundle, Plan& plan) {
    if (lines_a_bundle > most_lines_a_batch)
        throw Error(Fault::usage, "more than 2^30 lines in a bundle; choose a larger spacing");
    plan.batch =
        std::min(plan.batch, static_cast<std::uint32_t>(most_lines_a_batch / lines_a_bundle));
}

void plan_lines(const Patches& patches, const SolveSettings& settings, Plan& plan) {
    double disc = pi * plan.sphere.radius * plan.sphere.radius;
    plan.spacing = settings.line_spacing > 0
                       ? settings.line_spacing
                       : std::sqrt(mean_area(patches) / settings.lines_per_patch);
    plan.cell = plan.spacing * plan.spacing;
    if (settings.method == Method::bundles)
        check_spacing(plan.spacing, plan.sphere.radius);
    // A bundle's lines through the sphere, and so the independent lines that stand for it.
    double lines_a_bundle = disc / plan.cell;
    if (settings.bundles)
        plan.bundles = settings.bundles;
    else if (settings.lines)
        plan.bundles = static_cast<std::uint64_t>(
            std::max(1.0, std::round(static_cast<double>(settings.lines) / lines_a_bundle)));
    else
        plan.bundles = settings.target_error > 0 ? trial_bundles(patches) : 4096;
    if (follows_lines(settings)) {
        plan.lines_a_unit = static_cast<std::uint64_t>(std::max(1.0, std::round(lines_a_bundle)));
        plan.lines = settings.lines ? settings.lines : plan.bundles * plan.lines_a_unit;
        plan.lines_a_unit = std::min(plan.lines_a_unit, plan.lines);
        plan.bundles = (plan.lines - 1) / plan.lines_a_unit + 1;
        plan.cell = disc / static_cast<double>(plan.lines_a_unit);
    }
    plan.groups = groups_of(patches, settings, plan.bundles);
    plan.bundles = (plan.bundles - 1) / plan.groups + 1;
    plan.gathering = gathering_bundles(patches, settings, plan.bundles);
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
        plan.batch =
            static_cast<std::uint32_t>(std::clamp<std::uint64_t>(plan.passing() / 256, 1, 64));
    if (plan.batch > 0)
        limit_batch(disc / plan.cell, plan);
}

// The methods that send single rays from patches: a thousand a patch where nothing is said.
void plan_local_rays(const Patches& patches, const SolveSettings& settings, Plan& plan) {
    plan.lines = settings.lines ? settings.lines : 1000 * patches.count();
    plan.bundles = 0;
    plan.spacing = 0;
    // All shots together send P / (1 - ρ): so many rays leave in all as lines were asked for.
    if (settings.method == Method::progressive)
        plan.shot_rays = static_cast<double>(plan.lines) * (1 - mean_reflectance(patches));
}

// Direct light must never be what the error stops at: its rays, whose sequence is even, grow as an
// eighth of the lines' exits, and four hundred meet a patch of mean size at least.
std::uint64_t default_rays(const Patches& patches, const Plan& plan) {
    double area = mean_area(patches) * static_cast<double>(patches.count());
    double exits = static_cast<double>(plan.groups * plan.bundles) * area / (2 * plan.cell);
    double rays = std::max(0.125 * exits, 400.0 * static_cast<double>(patches.count()));
    return static_cast<std::uint64_t>(std::min(rays, 4.0e9));
}

}  // namespace

double sky_bound(const Sky& sky, std::uint32_t band) {
    switch (sky.kind) {
        case Sky::Kind::dark:
            return 0;
        case Sky::Kind::uniform:
            return sky.zenith[band];
        case Sky::Kind::gradient:
            return std::max({sky.zenith[band], sky.horizon[band], sky.ground[band]});
        case Sky::Kind::image:
            break;
    }
    float most = 0;
    for (const glm::vec3& texel : sky.image.texels)
        most = std::max({most, texel.x, texel.y, texel.z});
    return most * sky.scale;
}

namespace {

// Bytes of the stages that follow one another, and what they all work on.
struct Footprint {
    const Scene& scene;
    const Patches& patches;
    const SolveSettings& settings;
    std::uint64_t count = patches.count();
    std::uint32_t bands = patches.bands;
    unsigned threads = thread_count(settings.threads);
    unsigned banks = Banks::count(count, bands, threads, bank_limit(settings));
    bool local = needs_rays(scene, patches, settings);

    // The program with its libraries; surfaces as read, and the ray tracer's own copy of them with
    // its tree.
    std::uint64_t loaded() const {
        return (std::uint64_t(132) << 20) + count * (8 + bands * 8) +
               scene.surfaces.size() * (sizeof(Surface) + sizeof(SurfaceGrid) + 200) +
               scene.positions.size() * (sizeof(glm::dvec3) + 12);
    }
    std::uint64_t all_banks() const { return banks * Banks::bytes_a_bank(count, bands); }
    // Direct light: an irradiance. Single shots: what they took, and the exitance they leave.
    std::uint64_t direct() const {
        return count * ((local ? bands * 4 : 0) + (settings.shots > 0 ? bands * 4 : 0));
    }
    // Mean and spread of the groups before.
    std::uint64_t groups() const {
        const bool several = settings.method == Method::bundles && settings.groups != 1;
        return several ? count * (bands * 8 + 8) : 0;
    }
    // The cells that send, with their power.
    std::uint64_t first_shot() const {
        std::uint64_t cells = 0;
        for (std::size_t patch = 0; local && patch < count; ++patch)
            cells += std::any_of(&patches.emission[patch * bands],
                                 &patches.emission[patch * bands] + bands,
                                 [](float emission) { return emission > 0; });
        bool all = settings.shots > 0 || settings.method == Method::progressive ||
                   settings.method == Method::particles || settings.first_shot == FirstShot::exact;
        return all_banks() + groups() + cells * (sizeof(Emitter) + bands * 8 + 8) +
               (all ? count * (100 + bands * 12) : 0);
    }
    // What was sent, what exits carry, pairs on their way. A projection holds corners, and each
    // surface in a tile or two.
    std::uint64_t pass() const {
        std::uint64_t projections = settings.method == Method::bundles ? 16 : 0;
        return all_banks() + direct() + groups() + count * (bands * 8 + lanes(bands) * 4) +
               (banks < threads ? Partition::bytes(threads) : 0) +
               projections * (scene.surfaces.size() * 8 + scene.positions.size() * 12) +
               (settings.method == Method::matrix ? matrix_bytes(count) : 0);
    }
    // Irradiance and crossings beside what exits carry; radiosity in its place once that is over.
    std::uint64_t gather() const {
        return all_banks() + direct() + groups() + count * (bands * 4 + 8) +
               count * std::max(lanes(bands) * 4, bands * 4);
    }
};

}  // namespace

std::uint64_t predicted_memory(const Scene& scene, const Patches& patches,
                               const SolveSettings& settings) {
    const Footprint footprint{scene, patches, settings};
    return footprint.loaded() +
           std::max({footprint.first_shot(), footprint.pass(), footprint.gather()});
}

std::uint64_t bank_limit(const SolveSettings& settings) {
    std::uint64_t limit = std::uint64_t(1) << 28;
    return settings.max_memory ? std::min(limit, settings.max_memory / 4) : limit;
}

bool needs_rays(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    return settings.method != Method::bundles || !scene.lights.empty() || settings.shots > 0 ||
           (emits(patches) && settings.first_shot != FirstShot::off);
}

namespace {

void check(const SolveSettings& settings) {
    if (settings.bundles && settings.lines)
        throw Error(Fault::usage, "--bundles and --lines contradict each other; give one");
    if (settings.target_error > 0 && (settings.method != Method::bundles || settings.groups == 1))
        throw Error(Fault::usage, "--target-error needs --method bundles and more than one group");
    if (!(settings.lines_per_patch > 0) || settings.line_spacing < 0)
        throw Error(Fault::usage, "lines per patch and line spacing must be positive");
    bool bundles = settings.method == Method::bundles || settings.method == Method::lines;
    if (!bundles && settings.bundles)
        throw Error(Fault::usage, std::string("--bundles has no meaning for --method ") +
                                      method_name(settings.method) + "; give --lines");
}

// What may be taken: as told, and of a dense matrix never more than the machine has.
void check_memory(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    std::uint64_t need = predicted_memory(scene, patches, settings), limit = settings.max_memory;
    if (settings.method == Method::matrix)
        limit = limit ? std::min(limit, machine_memory()) : machine_memory();
    if (limit == 0 || need <= limit)
        return;
    std::string what = "this run needs about " + std::to_string((need >> 20) + 1) +
                       " MiB, more than the " + std::to_string(limit >> 20) + " MiB allowed; ";
    if (settings.method == Method::matrix)
        throw Error(Fault::memory, what +
                                       "the matrix grows with the square of the patches: choose "
                                       "larger patches or another --method");
    throw Error(Fault::memory, what + "choose larger patches or raise --max-memory");
}

}  // namespace

Plan make_plan(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    check(settings);
    check_memory(scene, patches, settings);
    Plan plan;
    plan.threads = thread_count(settings.threads);
    plan.bank_bytes = bank_limit(settings);
    plan.sphere = line_sphere(scene, settings.sphere_radius);
    for (float reflectance : patches.reflectance)
        plan.highest_reflectance = std::max<double>(plan.highest_reflectance, reflectance);
    plan_lines(patches, settings, plan);
    // All rounds' groups add up their quanta.
    const double times = plan.groups * (settings.target_error > 0 ? most_rounds : 1);
    plan.watts_per_quantum =
        quantum(times * power_bound(scene, patches, plan.sphere), plan.highest_reflectance);
    plan.first_shot = settings.first_shot;
    bool local = settings.method == Method::progressive || settings.method == Method::particles;
    if (plan.first_shot == FirstShot::automatic)
        plan.first_shot =
            local || settings.method == Method::matrix ? FirstShot::off : FirstShot::rays;
    std::uint64_t rays =
        settings.first_shot_rays ? settings.first_shot_rays : default_rays(patches, plan);
    rays = (rays - 1) / plan.groups + 1;
    plan.shot_rays = static_cast<double>(rays);
    if (plan.first_shot == FirstShot::rays && emits(patches))
        plan.first_shot_rays = rays;
    plan.shoot_each = plan.first_shot_rays > 0 || settings.shots > 0;
    if (local)
        plan_local_rays(patches, settings, plan);
    return plan;
}

const char* method_name(Method method) {
    switch (method) {
        case Method::bundles:
            return "bundles";
        case Method::lines:
            return "lines";
        case Method::progressive:
            return "progressive";
        case Method::particles:
            return "particles";
        case Method::matrix:
            break;
    }
    return "matrix";
}

}  // namespace parallux
