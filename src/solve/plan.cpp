#include "solve/plan.h"

#include <algorithm>
#include <string>

#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "solve/memory.h"
#include "solve/plan_lines.h"
#include "solve/plan_shots.h"
#include "solve/power.h"

namespace parallux {

namespace {

void check(const SolveSettings& settings) {
    if (settings.bundles && settings.lines)
        throw Error(Fault::usage, "--bundles and --lines contradict each other; give one");
    if (settings.target_error > 0 && (settings.method != Method::bundles || settings.groups == 1))
        throw Error(Fault::usage, "--target-error needs --method bundles and more than one group");
    if (!(settings.lines_per_patch >= 0) || !(settings.line_spacing >= 0))
        throw Error(Fault::usage, "lines per patch and line spacing must not be negative");
    bool bundles = settings.method == Method::bundles || settings.method == Method::lines;
    if (!bundles && settings.bundles)
        throw Error(Fault::usage, std::string("--bundles has no meaning for --method ") +
                                      method_name(settings.method) + "; give --lines");
}

// What knows of one tile alone.
void check_periodic(const Scene& scene, const SolveSettings& settings) {
    if (settings.method != Method::bundles)
        throw Error(Fault::usage, "a periodic scene is solved by --method bundles alone");
    const bool shoots = settings.first_shot == FirstShot::rays ||
                        settings.first_shot == FirstShot::exact || settings.shots > 0;
    if (shoots)
        throw Error(Fault::usage,
                    "a periodic scene has no local shots; leave --first-shot and "
                    "--shots away");
    for (const Light& light : scene.lights)
        if (light.kind != Light::Kind::directional)
            throw Error(Fault::usage, "light \"" + light.name +
                                          "\": a periodic scene has lights from far away alone, "
                                          "or surfaces that emit");
}

// Mirrors and glass are known to bundles with local walks, and to rays.
void check_specular(const Scene& scene, const SolveSettings& settings) {
    const char* with = "mirrors and glass are solved by --method bundles, both ways";
    if (settings.method != Method::bundles || settings.direction != Direction::bidirectional)
        throw Error(Fault::usage, with);
    if (settings.first_shot == FirstShot::exact)
        throw Error(Fault::usage,
                    "form factors know nothing of mirrors and glass: choose --first-shot rays");
    if (is_periodic(scene))
        throw Error(Fault::usage,
                    "a periodic scene has no mirrors or glass: walks off them know "
                    "of one tile");
}

}  // namespace

Plan make_plan(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const Trial& trial) {
    check(settings);
    const bool periodic = is_periodic(scene);
    if (periodic)
        check_periodic(scene, settings);
    if (!patches.specular.empty())
        check_specular(scene, settings);
    check_memory(scene, patches, settings);
    Plan plan;
    plan.trial = trial;
    plan.threads = thread_count(settings.threads);
    plan.bank_bytes = bank_limit(settings);
    plan.sphere = line_sphere(scene, settings.sphere_radius);
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k)
        plan.highest_reflectance = std::max<double>(plan.highest_reflectance, patches.albedo(k));
    plan_lines(patches, settings, plan);
    check_copies(scene, plan.sphere.radius, plan.spacing);
    // All rounds' groups add up their quanta.
    const double times = plan.groups * (settings.target_error > 0 ? most_rounds : 1);
    plan.watts_per_quantum =
        quantum(times * power_bound(scene, patches, plan.sphere), plan.highest_reflectance);
    if (periodic) {
        SolveSettings without = settings;
        without.first_shot = FirstShot::off;
        plan_shots(scene, patches, without, plan);
    } else {
        plan_shots(scene, patches, settings, plan);
    }
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
