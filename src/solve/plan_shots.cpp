#include "solve/plan_shots.h"

#include <algorithm>
#include <cmath>

#include "solve/plan_lines.h"
#include "solve/shot_exact.h"
#include "solve/sources.h"

namespace parallux {

namespace {

bool emits(const Patches& patches) {
    return std::any_of(patches.emission.begin(), patches.emission.end(),
                       [](float e) { return e > 0; });
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

constexpr double most_rays = 4.0e9;

// Exits of the lines of all groups.
double all_exits(const Patches& patches, const Plan& plan) {
    const double area = mean_area(patches) * static_cast<double>(patches.count());
    return static_cast<double>(plan.groups * plan.bundles) * area / (2 * plan.cell);
}

// Until it is tried how noisy direct light is: an eighth of the lines' exits, or four hundred rays
// to a patch of mean size.
std::uint64_t default_rays(const Patches& patches, const Plan& plan) {
    const double rays =
        std::max(0.125 * all_exits(patches, plan), 400.0 * static_cast<double>(patches.count()));
    return static_cast<std::uint64_t>(std::min(rays, most_rays));
}

// Exact form factors in scenes of few surfaces, whose shadows are found in closed form: direct
// light is then all but free of noise. A pair of source and cell takes as long as some 25 rays in
// each group; worth it while that is at most four times what rays would take. In meshes shadows
// have to be sampled, and rays from the sources get further in equal time.
bool is_exact_cheap(const Scene& scene, const Patches& patches, const Plan& plan,
                    std::uint64_t rays) {
    constexpr double rays_a_pair = 25, worth = 4;
    if (scene.surfaces.size() > ExactShot::few_surfaces || !patches.specular.empty())
        return false;
    const double pairs =
        static_cast<double>(count_sources(scene, patches)) * static_cast<double>(patches.count());
    return pairs * rays_a_pair * plan.groups <= worth * static_cast<double>(rays);
}

// The rays of a group's first shot, so that direct light and lines take the time that lowers the
// error most. Lines leave a patch with about the variance of independent ones, for what else they
// do; a ray takes as long as eight exits. The error by time is least where
//     d/dr (v / r + n / e) (8 r + e) = 0,  r = e √(v / 8 n).
std::uint64_t suitable_rays(const Patches& patches, const Plan& plan) {
    constexpr double exits_a_ray = 8, fewest = 50;
    const double count = static_cast<double>(patches.count());
    const double rays =
        all_exits(patches, plan) * std::sqrt(plan.trial.variance / (exits_a_ray * count));
    return static_cast<std::uint64_t>(std::clamp(rays, fewest * count, most_rays)) / plan.groups +
           1;
}

}  // namespace

bool needs_rays(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    return settings.method != Method::bundles || !patches.specular.empty() ||
           !scene.lights.empty() || settings.shots > 0 ||
           (emits(patches) && settings.first_shot != FirstShot::off);
}

void plan_shots(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                Plan& plan) {
    const bool local =
        settings.method == Method::progressive || settings.method == Method::particles;
    std::uint64_t rays =
        settings.first_shot_rays ? settings.first_shot_rays : default_rays(patches, plan);
    plan.first_shot = settings.first_shot;
    if (plan.first_shot == FirstShot::automatic) {
        if (local || settings.method == Method::matrix)
            plan.first_shot = FirstShot::off;
        else if (!plan.trial.known && settings.first_shot_rays == 0 &&
                 is_exact_cheap(scene, patches, plan, rays))
            plan.first_shot = FirstShot::exact;
        else
            plan.first_shot = FirstShot::rays;
    }
    rays = (rays - 1) / plan.groups + 1;
    // Shadows get finer as the lines do: 1 with 512 bundles a group.
    plan.shot_effort = std::clamp(std::sqrt(static_cast<double>(plan.bundles) / 512), 0.5, 8.0);
    plan.shot_rays = static_cast<double>(rays);
    if (plan.first_shot == FirstShot::rays && emits(patches))
        plan.first_shot_rays = rays;
    plan.try_rays = plan.first_shot_rays > 0 && settings.method == Method::bundles &&
                    settings.first_shot_rays == 0;
    if (plan.try_rays && plan.trial.known)
        plan.first_shot_rays = suitable_rays(patches, plan);
    // Shots differ from group to group where there is anything at random in them.
    plan.shoot_each = plan.first_shot_rays > 0 || plan.first_shot == FirstShot::exact ||
                      settings.shots > 0 || (!patches.specular.empty() && !scene.lights.empty());
    if (!patches.specular.empty())
        plan.light_walks = rays;
    if (local)
        plan_local_rays(patches, settings, plan);
}

}  // namespace parallux
