#include "cli/change_options.h"
#include "cli/options.h"
#include "cli/sky_options.h"

namespace parallux {

// Lengths become metres here, when --scale is read.
void settle(SolveOptions& o) {
    auto contradict = [](bool wrong, const char* what) {
        if (wrong)
            throw Error(Fault::usage, what);
    };
    contradict(o.quiet && o.progress == ProgressMode::on,
               "--quiet and --progress on exclude each other");
    bool shot_by_rays =
        o.solve.first_shot == FirstShot::rays || o.solve.first_shot == FirstShot::automatic;
    contradict(!shot_by_rays && o.solve.first_shot_rays > 0,
               "--first-shot-rays needs --first-shot rays");
    contradict(o.solve.checkpoints.any() && !o.fluxes.empty(),
               "--fluxes has no checkpoints; leave --checkpoint and --resume away");
    contradict(o.refresh > 0 && (o.solve.method != Method::bundles || o.solve.groups == 1),
               "--refresh needs --method bundles and more than one group");
    bool independent = o.solve.method == Method::lines || o.solve.method == Method::matrix;
    contradict(!independent && o.solve.sphere_radius > 0,
               "--sphere-radius needs --method lines or matrix");
    const bool bakes = !o.bakes.empty() || !o.lightmap.empty();
    contradict(o.picture.exposure != 0 && o.images.empty() && !o.bake.unlit,
               "--exposure needs --image, or --bake with --unlit");
    contradict(o.picture.flat && o.images.empty() && !bakes,
               "--flat needs --image, --bake or --lightmap");
    contradict(o.lightmap_settings.own_uv && o.lightmap.empty() && o.save.empty(),
               "--lightmap-uv own or objects needs --lightmap or --save");
    contradict(o.bake.quantity != Quantity::radiosity && !bakes,
               "--quantity needs --bake or --lightmap");
    o.bake.flat = o.lightmap_settings.flat = o.picture.flat;
    settle_sky(o.load.sky);
    if (o.quiet && o.progress == ProgressMode::automatic)
        o.progress = ProgressMode::off;
    settle_changes(o);
    for (double* length : {&o.patches.size, &o.solve.line_spacing, &o.solve.sphere_radius})
        *length *= o.load.scale;
}

}  // namespace parallux
