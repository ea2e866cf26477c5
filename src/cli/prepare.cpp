#include "cli/prepare.h"

#include "cli/changes.h"
#include "cli/reuse_options.h"
#include "cli/summary.h"

namespace parallux {

namespace {

// Of the objects that have surfaces.
std::vector<std::filesystem::path> used_lightmaps(const std::filesystem::path& file,
                                                  const Scene& scene) {
    const std::vector<std::filesystem::path> all = object_lightmaps(file, scene);
    std::vector<bool> used(all.size());
    for (const Surface& surface : scene.surfaces)
        used[surface.object] = true;
    std::vector<std::filesystem::path> files;
    for (std::size_t object = 0; object < all.size(); ++object)
        if (used[object])
            files.push_back(all[object]);
    return files;
}

}  // namespace

Prepared prepare(SolveOptions& options) {
    check_outputs(options);
    Prepared p;
    p.scene = load_scene(options.scene, options.load);
    change_scene(options, p.scene);
    check_camera(options, p.scene);
    if (!options.lightmap.empty() && options.lightmap_settings.by_object) {
        options.object_lightmaps = used_lightmaps(options.lightmap, p.scene);
        check_outputs(options);
    }
    if (!options.sensors.empty())
        p.measured.sensors = read_sensors(options.sensors, options.load.scale);
    if (!options.receivers.empty())
        p.measured.receivers = named_surfaces(p.scene, options.receivers, "--receivers");
    p.loaded = seconds_since_start();
    p.patches = make_patches(p.scene, options.patches);
    change_patches(options, p.patches);
    p.divided = seconds_since_start();
    return p;
}

int reuse_result(SolveOptions options) {
    SavedSolution result = read_result(options.result);
    recall(result, options);
    if (options.outputs().empty())
        throw Error(Fault::usage, "expected an output, as --image room.png or --bake room.glb");
    Prepared p = prepare(options);
    check_result(options.result, result, p.scene, p.patches);
    write_outputs(options, p.scene, p.patches, result.solution, p.measured);
    if (!options.quiet)
        tell_reuse(options, p.scene, p.patches, result);
    return 0;
}

}  // namespace parallux
