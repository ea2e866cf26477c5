#include "efficiency/cases.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>

#include "parallux/error.h"
#include "random.h"

namespace parallux::efficiency {

namespace {

const std::filesystem::path scenes = PARALLUX_SCENES, shared = PARALLUX_SHARED_SCENES;

const std::map<std::string, std::filesystem::path>& shared_files() {
    static const std::map<std::string, std::filesystem::path> files{
        {"mgf-classroom", shared / "mgf-classroom" / "scene.gltf"},
        {"cornell-nvpro", shared / "cornell-nvpro" / "cornellBox.gltf"},
        {"bitterli-modern-hall", shared / "bitterli-modern-hall" / "scene.gltf"}};
    return files;
}

Scene with_reflectance(Scene scene, float reflectance) {
    for (Material& material : scene.materials)
        for (std::uint32_t band = 0; band < scene.bands; ++band)
            material.reflectance[band] = reflectance;
    return scene;
}

// The Cornell box as published is open at z = 0. The missing wall, of the floor's material, hangs
// on the corners that are there; its corners are no parallelogram, so it is two triangles.
Scene closed_cornell_box() {
    Scene scene = load_scene(scenes / "cornell_box.gltf");
    const Bounds bounds = scene_bounds(scene);
    const double middle_x = (bounds.low.x + bounds.high.x) / 2;
    const double middle_y = (bounds.low.y + bounds.high.y) / 2;
    std::uint32_t corner[4] = {none, none, none, none};  // counter-clockwise, seen from within
    for (std::uint32_t k = 0; k < scene.positions.size(); ++k) {
        const glm::dvec3& p = scene.positions[k];
        if (p.z == bounds.low.z)
            corner[p.y < middle_y ? (p.x < middle_x ? 0 : 1) : (p.x < middle_x ? 3 : 2)] = k;
    }
    if (std::count(corner, corner + 4, none) > 0)
        throw Error(Fault::internal, "cornell_box.gltf has no four corners in front");
    Surface wall;
    wall.material = scene.surfaces.front().material;
    wall.object = static_cast<std::uint32_t>(scene.objects.size());
    scene.objects.push_back("front wall");
    for (int half = 0; half < 2; ++half) {
        wall.corner = {corner[0], corner[1 + half], corner[2 + half], none};
        scene.surfaces.push_back(wall);
        if (!scene.attributes.empty())
            scene.attributes.emplace_back();
    }
    scene.triangles += 2;
    return scene;
}

std::uint64_t fingerprint_of(const Scene& scene, const Patches& patches) {
    std::uint64_t hash = mix64(patches.bands);
    auto add = [&](std::uint64_t word) { hash = mix64(hash ^ word) + 0x9e3779b97f4a7c15ull; };
    auto add_real = [&](double value) { add(std::bit_cast<std::uint64_t>(value)); };
    for (const glm::dvec3& position : scene.positions)
        for (int axis = 0; axis < 3; ++axis)
            add_real(position[axis]);
    for (const Surface& surface : scene.surfaces)
        for (std::uint32_t corner : surface.corner)
            add(corner);
    for (const SurfaceGrid& grid : patches.grids) {
        add(grid.front + (std::uint64_t(grid.back) << 32));
        add(grid.nu + (std::uint64_t(grid.nv) << 32));
    }
    for (double area : patches.area)
        add_real(area);
    for (float value : patches.reflectance)
        add_real(value);
    for (float value : patches.emission)
        add_real(value);
    add(static_cast<std::uint64_t>(scene.sky.kind) + (scene.lights.size() << 8));
    return hash;
}

bool emits(const Patches& patches, std::size_t patch) {
    const float* emission = &patches.emission[patch * patches.bands];
    return std::any_of(emission, emission + patches.bands, [](float e) { return e > 0; });
}

Case finish(const std::string& name, Scene scene, std::uint64_t patches) {
    Case result;
    result.name = name;
    result.scene = std::move(scene);
    PatchSettings division;
    division.count = patches;
    result.patches = make_patches(result.scene, division);
    for (std::size_t patch = 0; patch < result.patches.count(); ++patch)
        result.weight.push_back(emits(result.patches, patch) ? 0 : result.patches.area[patch]);
    for (const SurfaceGrid& grid : result.patches.grids)
        result.emitters += grid.front != none && emits(result.patches, grid.front);
    result.fingerprint = fingerprint_of(result.scene, result.patches);
    return result;
}

}  // namespace

const std::vector<std::string>& case_names() {
    static const std::vector<std::string> names{
        "paper-12150",   "paper-12150-rho80", "cornell-1000",        "cornell-10000",
        "mgf-classroom", "cornell-nvpro",     "bitterli-modern-hall"};
    return names;
}

bool available(const std::string& name) {
    const auto file = shared_files().find(name);
    return file == shared_files().end() || std::filesystem::exists(file->second);
}

Case make_case(const std::string& name) {
    if (name == "paper-12150")
        return finish(name, load_scene(scenes / "paper_12150.json"), 0);
    if (name == "paper-12150-rho80")
        return finish(name, with_reflectance(load_scene(scenes / "paper_12150.json"), 0.8f), 0);
    if (name == "cornell-10000")
        return finish(name, closed_cornell_box(), 10'000);
    if (name == "cornell-1000")
        return finish(name, closed_cornell_box(), 1000);
    if (name == tiny_case)
        return finish(name, load_scene(scenes / "paper_scene2_114.json"), 0);
    const auto file = shared_files().find(name);
    return finish(name, load_scene(file == shared_files().end() ? name : file->second.string()), 0);
}

}  // namespace parallux::efficiency
