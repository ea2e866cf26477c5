#include "scene/gltf_nodes.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {
namespace {

// glTF cameras and lights look along -z; mirrored or skewed nodes only turn them.
glm::dvec3 looking(const JsonView& node, const glm::dmat4& world, const glm::dvec3& local) {
    glm::dvec3 direction = glm::dmat3(world) * local;
    double length = glm::length(direction);
    if (!(length > 1e-150 && length < 1e150))
        node.fail("its transform leaves no direction to look in");
    return direction / length;
}

glm::dvec3 place_of(const JsonView& node, const glm::dmat4& world, double scale) {
    glm::dvec3 p = glm::dvec3(world[3]) * scale, size = glm::abs(p);
    if (!(size.x <= 1e15 && size.y <= 1e15 && size.z <= 1e15))
        node.fail("its position is not a number or beyond 1e15");
    return p;
}

glm::dmat4 rotation_of(const JsonView& quaternion) {
    if (quaternion.size() != 4)
        quaternion.fail("must have four numbers");
    double q[4], norm = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        q[i] = quaternion.at(i).number();
        norm += q[i] * q[i];
    }
    if (!(norm > 1e-12))
        quaternion.fail("is no rotation");
    double s = 2 / norm, x = q[0], y = q[1], z = q[2], w = q[3];
    glm::dmat4 m(1);  // columns
    m[0] = {1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w), 0};
    m[1] = {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w), 0};
    m[2] = {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y), 0};
    return m;
}

double clamp_angle(const JsonView& json, const char* key, double otherwise) {
    auto found = json.find(key);
    return found ? found->number(0, pi / 2 + 1e-6) : otherwise;
}

}  // namespace

glm::dmat4 node_transform(const JsonView& node) {
    glm::dmat4 m(1);
    if (auto matrix = node.find("matrix")) {
        if (matrix->size() != 16)
            matrix->fail("must have sixteen numbers");
        for (int i = 0; i < 16; ++i)
            m[i / 4][i % 4] = matrix->at(static_cast<std::size_t>(i)).number();
        return m;
    }
    if (auto rotation = node.find("rotation"))
        m = rotation_of(*rotation);
    if (auto scale = node.find("scale")) {
        glm::dvec3 s = scale->vector();
        for (int i = 0; i < 3; ++i)
            m[i] *= s[i];
    }
    if (auto translation = node.find("translation"))
        m[3] = glm::dvec4(translation->vector(), 1);
    return m;
}

void add_gltf_camera(Scene& scene, const GltfDocument& document, const JsonView& node,
                     const glm::dmat4& world, double scale) {
    JsonView json = document.element("cameras", node.at("camera"));
    std::string number = "camera " + std::to_string(scene.cameras.size());
    Camera camera;
    camera.name = name_or(json.text_or("name", ""), name_or(node.text_or("name", ""), number));
    camera.position = place_of(node, world, scale);
    camera.forward = looking(node, world, {0, 0, -1});
    glm::dvec3 right = glm::cross(camera.forward, looking(node, world, {0, 1, 0}));
    if (!(glm::length(right) > 1e-9))
        node.fail("its transform leaves the camera no upright");
    camera.up = glm::normalize(glm::cross(right, camera.forward));
    const std::string& type = json.at("type").text();
    if (type == "perspective") {
        JsonView lens = json.at("perspective");
        camera.vertical_fov = lens.at("yfov").number(1e-6, pi - 1e-6);
        if (auto aspect = lens.find("aspectRatio"))
            camera.aspect = aspect->number(1e-6, 1e6);
    } else if (type == "orthographic") {
        JsonView lens = json.at("orthographic");
        double height = std::abs(lens.at("ymag").number()), width = lens.at("xmag").number();
        if (height == 0 || width == 0)
            lens.fail("xmag and ymag must not be 0");
        camera.orthographic_height = 2 * height * scale;
        camera.aspect = std::abs(width) / height;
    } else {
        json.at("type").fail("must be perspective or orthographic");
    }
    scene.cameras.push_back(std::move(camera));
}

void add_gltf_light(Scene& scene, const JsonView& root, const JsonView& node,
                    const glm::dmat4& world, double scale) {
    auto extensions = node.find("extensions");
    auto reference = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    if (!reference)
        return;
    JsonView lights = root.at("extensions").at("KHR_lights_punctual").at("lights");
    JsonView json = lights.at(static_cast<std::size_t>(reference->at("light").count(none)));
    Light light;
    light.name = name_or(json.text_or("name", ""), "light " + std::to_string(scene.lights.size()));
    light.position = place_of(node, world, scale);
    light.direction = looking(node, world, {0, 0, -1});
    const std::string& type = json.at("type").text();
    if (type == "directional") {
        light.kind = Light::Kind::directional;
    } else if (type == "spot") {
        light.kind = Light::Kind::spot;
        if (auto spot = json.find("spot")) {
            light.inner_cone = clamp_angle(*spot, "innerConeAngle", 0);
            light.outer_cone = clamp_angle(*spot, "outerConeAngle", pi / 4);
            if (light.inner_cone > light.outer_cone)
                spot->fail("innerConeAngle is more than outerConeAngle");
        }
    } else if (type != "point") {
        json.at("type").fail("must be point, spot or directional");
    }
    // Photometric intensities (candela, lux) are taken as they are: the picture is then in lm.
    auto given = json.find("intensity");
    double intensity = given ? given->number(0, 1e15) : 1;
    light.intensity = Spectrum();
    glm::dvec3 colour = json.has("color") ? json.at("color").vector() : glm::dvec3(1);
    for (int c = 0; c < 3; ++c) {
        if (colour[c] < 0)
            json.at("color").fail("must not be negative");
        light.intensity[c] = static_cast<float>(intensity * colour[c]);
    }
    if (auto range = json.find("range"))
        light.range = range->number(0, 1e15) * scale;
    scene.lights.push_back(std::move(light));
}

}  // namespace parallux
