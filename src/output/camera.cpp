#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/ray_scene.h"
#include "parallux/error.h"
#include "parallux/picture.h"

namespace parallux {

namespace {

glm::dvec3 up_axis(const Scene& scene) {
    if (scene.sky.kind != Sky::Kind::dark)
        return glm::normalize(scene.sky.up);
    std::string ending = scene.file.extension().string();
    for (char& c : ending)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    bool z_up = ending == ".json" || ending == ".stl";
    return z_up ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
}

// Looks from `position` to `target`, upright.
Camera looking(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& up) {
    Camera camera;
    camera.name = "automatic";
    camera.position = position;
    camera.forward = glm::normalize(target - position);
    camera.up = glm::normalize(up - glm::dot(up, camera.forward) * camera.forward);
    camera.vertical_fov = pi / 3;
    return camera;
}

// The nearest surface that a picture would show, backs of one-sided ones left out.
double distance_to_wall(const Scene& scene, const RayScene& rays, const glm::dvec3& from,
                        const glm::dvec3& direction) {
    std::vector<SurfaceHit> hits;
    rays.all(from, direction, HUGE_VAL, hits);
    for (const SurfaceHit& hit : hits)
        if (!hit.back || scene.materials[scene.surfaces[hit.surface].material].two_sided)
            return hit.t;
    return HUGE_VAL;
}

// Whether nearly all of 64 even directions meet a surface that can be seen from here.
bool is_inside(const Scene& scene, const RayScene& rays, const glm::dvec3& from) {
    int met = 0;
    for (int i = 0; i < 64; ++i) {
        double z = 1 - (2 * i + 1) / 64.0, r = std::sqrt(1 - z * z);
        double phi = i * 2.399963229728653;
        glm::dvec3 direction(r * std::cos(phi), r * std::sin(phi), z);
        met += std::isfinite(distance_to_wall(scene, rays, from, direction)) ? 1 : 0;
    }
    return met >= 58;
}

// Stands near one end of the room's longest side and looks along it, a little down.
Camera indoors(const Scene& scene, const RayScene& rays, const Bounds& bounds,
               const glm::dvec3& up) {
    glm::dvec3 middle = 0.5 * (bounds.low + bounds.high), side = bounds.high - bounds.low;
    glm::dvec3 along(0);
    double longest = -1;
    for (int axis = 2; axis >= 0; --axis) {
        glm::dvec3 unit(0);
        unit[axis] = 1;
        if (std::abs(glm::dot(unit, up)) < 0.7 && side[axis] > longest)
            longest = side[axis], along = unit;
    }
    double height = glm::dot(glm::abs(up), side);
    glm::dvec3 eye = middle + 0.05 * height * up;
    double room = std::min(distance_to_wall(scene, rays, eye, along), longest);
    double behind = std::min(distance_to_wall(scene, rays, eye, -along), longest);
    glm::dvec3 position = eye - std::max(behind - 0.05 * longest, 0.5 * behind) * along;
    return looking(position, eye + room * along - 0.1 * height * up, up);
}

// Stands outside, at three quarters and from above, far enough to see the bounding sphere.
Camera outdoors(const Bounds& bounds, const glm::dvec3& up) {
    glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    double radius = std::max(0.5 * glm::length(bounds.high - bounds.low), 1e-6);
    glm::dvec3 helper = std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    glm::dvec3 aside = glm::normalize(helper - glm::dot(helper, up) * up);
    glm::dvec3 towards = glm::normalize(glm::cross(aside, up));
    glm::dvec3 from = glm::normalize(0.6 * aside + towards + 0.55 * up);
    Camera camera = looking(middle + from, middle, up);
    camera.vertical_fov = 0.7;
    camera.position = middle + 1.02 * radius / std::sin(0.5 * camera.vertical_fov) * from;
    return camera;
}

Camera whole_scene(const Scene& scene) {
    Bounds bounds = scene_bounds(scene);
    glm::dvec3 up = up_axis(scene);
    RayScene rays(scene, 1);
    bool inside = is_inside(scene, rays, 0.5 * (bounds.low + bounds.high));
    return inside ? indoors(scene, rays, bounds, up) : outdoors(bounds, up);
}

}  // namespace

Camera choose_camera(const Scene& scene, const std::string& name_or_index) {
    if (name_or_index.empty())
        return scene.cameras.empty() ? whole_scene(scene) : scene.cameras.front();
    for (const Camera& camera : scene.cameras)
        if (camera.name == name_or_index)
            return camera;
    std::size_t index = 0;
    const char* end = name_or_index.data() + name_or_index.size();
    auto [stop, failure] = std::from_chars(name_or_index.data(), end, index);
    if (failure == std::errc() && stop == end && index < scene.cameras.size())
        return scene.cameras[index];
    // Name those there are.
    std::string there;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        there += (i ? ", " : "") + std::to_string(i) + " '" + scene.cameras[i].name + "'";
    throw Error(Fault::usage, scene.file.string() + ": no camera '" + name_or_index + "'; there " +
                                  (there.empty() ? "are none in the scene" : "is " + there));
}

}  // namespace parallux
