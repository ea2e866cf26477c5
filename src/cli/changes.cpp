#include "cli/changes.h"

#include <algorithm>

#include "lines/periodic.h"

namespace parallux {

namespace {

// A PNG shows one band in grey or three in colour.
void check_shown_bands(const SolveOptions& options, const Scene& scene) {
    const std::vector<std::uint32_t>& shown = options.picture.shown_bands;
    for (std::uint32_t band : shown)
        if (band >= scene.bands)
            throw Error(Fault::usage, "--band " + std::to_string(band) +
                                          ": the scene has bands 0 to " +
                                          std::to_string(scene.bands - 1));
    const bool png = std::any_of(options.images.begin(), options.images.end(),
                                 [](const auto& file) { return file.extension() == ".png"; });
    if (png && shown.empty() && scene.bands != 1 && scene.bands != 3)
        throw Error(Fault::usage, "--image: a PNG shows one band or three, the scene has " +
                                      std::to_string(scene.bands) +
                                      "; choose with --band B or --band R,G,B, or write .exr");
}

}  // namespace

void change_scene(const SolveOptions& options, Scene& scene) {
    const SceneChanges& changes = options.changes;
    if (!changes.exclude.empty())
        exclude_surfaces(scene, changes.exclude);
    if (!changes.materials.empty())
        set_materials(scene, changes.materials, changes.bands);
    else if (changes.bands > 0)
        set_bands(scene, changes.bands);
    if (!changes.temperatures.empty())
        Temperatures(changes.temperatures).apply(scene, changes.sky_temperature);
    check_shown_bands(options, scene);
    if (!options.sensors.empty() && is_periodic(scene))
        throw Error(
            Fault::usage,
            "--sensors: they gather along rays through one tile; a periodic scene has none");
    if (!options.receivers.empty())
        named_surfaces(scene, options.receivers, "--receivers");
}

void change_patches(const SolveOptions& options, Patches& patches) {
    if (!options.changes.temperatures.empty())
        Temperatures(options.changes.temperatures).apply(patches);
}

}  // namespace parallux
