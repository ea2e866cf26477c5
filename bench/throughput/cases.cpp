#include "throughput/cases.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "throughput/bundle_lines.h"
#include "throughput/room.h"

namespace parallux::throughput {

namespace {

const std::filesystem::path scenes = PARALLUX_SCENES;
const std::filesystem::path kitchen =
    std::filesystem::path(PARALLUX_SHARED_SCENES) / "bitterli-kitchen" / "scene.gltf";

// How a case is run unless the command line says otherwise. Bundles are so many that the solve
// takes some tenths of a second at least, at the speed that is aimed at.
struct Plan {
    std::uint64_t patches = 0;  // wanted; 0: as the scene says
    bool clusters = true;
    std::uint64_t bundles = 0;
    double lines_per_bundle = 0;  // 0: four lines a patch
};

// The paper's scene has one band, which is solved three times over as an RGB scene would be.
Scene in_rgb(Scene scene) {
    if (scene.bands == 1)
        for (Material& material : scene.materials)
            for (std::uint32_t band = 1; band < 3; ++band) {
                material.reflectance[band] = material.reflectance[0];
                material.emission[band] = material.emission[0];
            }
    scene.bands = 3;
    return scene;
}

Scene scene_of(const std::string& name, bool tiny, Plan& plan) {
    if (name == "paper-12150") {
        plan = {0, true, tiny ? 32u : 16384u, 0};
        return in_rgb(load_scene(scenes / "paper_12150.json"));
    }
    if (name == "paper-1200000") {
        plan = {tiny ? 40'000u : 1'200'000u, true, tiny ? 8u : 256u, 0};
        return in_rgb(load_scene(scenes / "paper_12150.json"));
    }
    if (name == "room-300000") {
        plan = {0, false, tiny ? 8u : 96u, tiny ? 128. * 128 : 1024. * 1024};
        return make_room(tiny ? 0.1 : 1);
    }
    plan = {300'000, true, 16, 2048. * 2048};
    if (name == "kitchen")
        return load_scene(kitchen);
    plan = {0, true, 64, 0};
    return load_scene(name);
}

double mean_area(const Patches& patches) {
    double total = 0;
    for (double area : patches.area)
        total += area;
    return total / static_cast<double>(patches.count());
}

}  // namespace

SolveSettings Case::settings(unsigned threads) const {
    SolveSettings settings;
    settings.first_shot = FirstShot::off;
    settings.bundles = bundles;
    settings.line_spacing = spacing;
    settings.gather_share = 0;  // one run, the pass alone
    settings.groups = 1;
    // What a run of the usual length has, and what longer ones have.
    settings.batch = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(bundles / 256, 16, 64));
    settings.threads = threads;
    return settings;
}

const std::vector<std::string>& case_names() {
    static const std::vector<std::string> names{"paper-12150", "paper-1200000", "room-300000",
                                                "kitchen"};
    return names;
}

bool available(const std::string& name) {
    return name != "kitchen" || std::filesystem::exists(kitchen);
}

Case make_case(const std::string& name, const CaseSettings& settings) {
    Case result;
    result.name = name;
    Plan plan;
    result.scene = scene_of(name, settings.tiny, plan);
    // Both belong to stages that are not timed here, and would have to be copied by every engine.
    result.scene.lights.clear();
    result.scene.sky = {};

    PatchSettings division;
    division.clusters = plan.clusters;
    division.count = settings.patches ? settings.patches : plan.patches;
    // Triangles without a grid are a patch each where they may not be joined.
    if (!plan.clusters && division.count == 0)
        division.size = 1e9;
    result.patches = make_patches(result.scene, division);

    result.bundles = settings.bundles ? settings.bundles : plan.bundles;
    double lines =
        settings.lines_per_bundle > 0 ? settings.lines_per_bundle : plan.lines_per_bundle;
    double area = mean_rectangle(result.scene, result.bundles);
    result.spacing = lines > 0 ? std::sqrt(area / lines) : std::sqrt(mean_area(result.patches) / 4);
    result.lines_per_bundle = area / (result.spacing * result.spacing);
    return result;
}

}  // namespace parallux::throughput
