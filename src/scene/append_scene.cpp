#include "scene/input.h"
#include "scene/parallux_json.h"

namespace parallux {
namespace {

std::uint32_t moved(std::uint32_t index, std::size_t by) {
    return index == none ? none : index + static_cast<std::uint32_t>(by);
}

}  // namespace

void append_scene(SceneBuilder& builder, Scene& mesh, double scale, const glm::dvec3& translate,
                  std::uint32_t material) {
    Scene& scene = builder.scene();
    double total = scale * builder.settings().scale;
    auto place = [&](const glm::dvec3& p) { return p * scale + translate; };
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        builder.check(place(mesh.positions[i]), mesh.file.string(), i);
        corners.push_back(builder.weld(place(mesh.positions[i])));
    }
    std::size_t objects = scene.objects.size(), materials = scene.materials.size(),
                textures = scene.textures.size();
    bool own = material == none;
    if (scene.triangles + mesh.triangles > max_triangles)
        input_error(scene.file, mesh.file.string(), "too many triangles with all meshes");
    scene.triangles += mesh.triangles;
    scene.zero_area += mesh.zero_area;
    if (own && !mesh.attributes.empty()) {
        scene.attributes.resize(scene.surfaces.size());
        scene.attributes.insert(scene.attributes.end(), mesh.attributes.begin(),
                                mesh.attributes.end());
    } else if (!scene.attributes.empty()) {
        scene.attributes.resize(scene.surfaces.size() + mesh.surfaces.size());
    }
    for (Surface s : mesh.surfaces) {
        for (std::uint32_t& c : s.corner)
            c = c == none ? none : corners[c];
        s.material = own ? moved(s.material, materials) : material;
        s.object = moved(s.object, objects);
        scene.surfaces.push_back(s);
    }
    scene.objects.insert(scene.objects.end(), mesh.objects.begin(), mesh.objects.end());
    for (Material& m : mesh.materials) {
        if (!own)
            break;
        m.reflectance_texture = moved(m.reflectance_texture, textures);
        m.emission_texture = moved(m.emission_texture, textures);
        scene.materials.push_back(std::move(m));
    }
    for (Texture& t : mesh.textures)
        if (own)
            scene.textures.push_back(std::move(t));
    for (Light& light : mesh.lights) {
        light.position = place(light.position) * builder.settings().scale;
        light.range *= total;
        if (scene.bands == 3)  // their colours have three bands
            scene.lights.push_back(std::move(light));
    }
    for (Camera& camera : mesh.cameras) {
        camera.position = place(camera.position) * builder.settings().scale;
        camera.orthographic_height *= total;
        scene.cameras.push_back(std::move(camera));
    }
    for (const std::string& warning : mesh.warnings)
        if (warning.find("have no area") == warning.npos)  // counted for the whole scene
            scene.warnings.push_back(printable(mesh.file.filename().string()) + ": " + warning);
}

}  // namespace parallux
