#include "error_bars/places.h"

#include <filesystem>

#include <glm/geometric.hpp>

namespace parallux::error_bars {

namespace {

std::uint32_t nearest_position(const Scene& scene, const glm::dvec3& wanted) {
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < scene.positions.size(); ++k)
        if (glm::distance(scene.positions[k], wanted) <
            glm::distance(scene.positions[best], wanted))
            best = k;
    return best;
}

// The box as measured has no front wall. Its four corners are not those of a parallelogram.
void add_front_wall(Scene& scene) {
    const std::uint32_t corners[] = {
        nearest_position(scene, {0, 0, 0}), nearest_position(scene, {0.5528, 0, 0}),
        nearest_position(scene, {0.556, 0.5488, 0}), nearest_position(scene, {0, 0.5488, 0})};
    const auto object = static_cast<std::uint32_t>(scene.objects.size());
    scene.objects.push_back("front wall");
    for (int k : {1, 2}) {
        Surface half;
        half.corner = {corners[0], corners[k], corners[k + 1], none};
        half.material = scene.surfaces.front().material;
        half.object = object;
        scene.surfaces.push_back(half);
        if (!scene.attributes.empty())
            scene.attributes.emplace_back();
    }
}

}  // namespace

Place make_place(const std::string& name, bool tiny) {
    const std::filesystem::path scenes = PARALLUX_SCENES;
    Place place;
    place.name = name;
    PatchSettings division;
    if (name == "paper-456") {
        place.scene = load_scene(scenes / "paper_scene2_456.json");
    } else if (name == "cornell-closed") {
        place.scene = load_scene(scenes / "cornell_box.gltf");
        add_front_wall(place.scene);
        division.count = tiny ? 150 : 500;
    } else if (name == "street") {
        place.scene = load_scene(scenes / "street_canyon.json");
        division.count = tiny ? 150 : 300;
    } else if (name == "paper-600") {
        place.scene = load_scene(scenes / "paper_scene1_600.json");
    } else if (name == "paper-1824") {
        place.scene = load_scene(scenes / "paper_scene2_1824.json");
    } else {
        place.scene = load_scene(scenes / "paper_12150.json");
    }
    place.patches = make_patches(place.scene, division);
    return place;
}

std::vector<std::string> interval_places(bool tiny) {
    if (tiny)
        return {"cornell-closed", "street"};
    return {"paper-456", "cornell-closed", "street"};
}

std::vector<std::string> slope_places(bool tiny) {
    if (tiny)
        return {"paper-600"};
    return {"paper-600", "paper-1824", "paper-12150"};
}

}  // namespace parallux::error_bars
