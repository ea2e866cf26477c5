#include "scene/parallux_json.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/input.h"

namespace parallux {
namespace {

double degrees(const JsonView& json, double low, double high) {
    return json.number(low, high) * pi / 180;
}

}  // namespace

void read_parallux(SceneBuilder& builder, const Json& json) {
    ParalluxReader(builder, JsonView(builder.scene().file, json)).read();
}

ParalluxReader::ParalluxReader(SceneBuilder& builder, const JsonView& root)
    : builder_(builder), scene_(builder.scene()), root_(root) {
    root_.only({"parallux", "comment", "$schema", "bands", "up", "scale", "materials", "surfaces",
                "meshes", "lights", "sky", "cameras", "line_sphere", "periodic"});
    if (root_.at("parallux").count(1000000) != 1)
        root_.at("parallux").fail("only version 1 is read");
    scene_.bands = static_cast<std::uint32_t>(root_.count_or("bands", 3, max_bands));
    if (scene_.bands == 0)
        root_.at("bands").fail("must be 1 to 8");
    scale_ = root_.has("scale") ? root_.at("scale").number(1e-12, 1e12) : 1;
    up_ = root_.has("up") ? direction(root_.at("up")) : glm::dvec3(0, 0, 1);
}

void ParalluxReader::read() {
    read_materials();
    read_surfaces();
    read_lights();
    read_sky();
    read_period();
    read_cameras();
    if (auto radius = root_.find("line_sphere"))
        scene_.line_sphere = radius->number(1e-15, 1e15) * scale_ * builder_.settings().scale;
}

// One number for all bands, or one a band.
Spectrum ParalluxReader::spectrum(const JsonView& json, double low, double high) const {
    Spectrum result;
    bool same = json.is_number();
    if (!same && json.size() != scene_.bands)
        json.fail("must be a number or have one for each of the " + std::to_string(scene_.bands) +
                  " bands");
    for (std::size_t b = 0; b < scene_.bands; ++b)
        result[b] = static_cast<float>((same ? json : json.at(b)).number(low, high));
    return result;
}

glm::dvec3 ParalluxReader::direction(const JsonView& json) const {
    glm::dvec3 v = json.vector();
    if (!(glm::length(v) > 0))
        json.fail("has no direction");
    return glm::normalize(v);
}

void ParalluxReader::read_materials() {
    auto list = root_.find("materials");
    for (std::size_t i = 0; list && i < list->size(); ++i) {
        JsonView json = list->at(i);
        json.only({"name", "comment", "reflectance", "transmittance", "back", "emission",
                   "two_sided", "mirror", "glass"});
        std::string name = json.text_or("name", "material " + std::to_string(i));
        Material m;
        m.name = printable(name);
        m.reflectance = builder_.settings().reflectance;
        if (auto reflectance = json.find("reflectance")) {
            m.reflectance = spectrum(*reflectance, 0, 1);
            for (float rho : m.reflectance.value)
                if (rho >= 1)
                    reflectance->fail("must be less than 1: light would never end");
        }
        if (auto transmittance = json.find("transmittance"))
            m.transmittance = spectrum(*transmittance, 0, 1);
        if (auto emission = json.find("emission"))
            m.emission = spectrum(*emission, 0, 1e15);
        m.two_sided = json.boolean_or("two_sided", false);
        if (auto back = json.find("back"))
            read_back(*back, m);
        read_specular(json, m);
        if (const std::string fault = side_fault(m); !fault.empty())
            json.fail(fault);
        if (!materials_.emplace(name, add_material(scene_, std::move(m))).second)
            json.fail("a second material \"" + printable(name) + "\"");
    }
}

// What the back has of its own; what it does not say is as on the front.
void ParalluxReader::read_back(const JsonView& json, Material& m) const {
    json.only({"reflectance", "transmittance"});
    m.own_back = true;
    m.back_reflectance = m.reflectance;
    m.back_transmittance = m.transmittance;
    if (auto reflectance = json.find("reflectance"))
        m.back_reflectance = spectrum(*reflectance, 0, 1);
    if (auto transmittance = json.find("transmittance"))
        m.back_transmittance = spectrum(*transmittance, 0, 1);
}

// What mirrors or is glass; where that takes all that arrives, nothing is left for a diffuse part.
void ParalluxReader::read_specular(const JsonView& json, Material& m) const {
    const auto mirror = json.find("mirror"), glass = json.find("glass");
    if (!mirror && !glass)
        return;
    if (mirror && glass)
        json.fail("a material is a mirror or glass");
    const JsonView& part = mirror ? *mirror : *glass;
    Specular& s = m.specular;
    s.kind = mirror ? Specular::Kind::mirror : Specular::Kind::glass;
    if (auto share = part.find("share"))
        s.share = static_cast<float>(share->number(0, 1));
    if (mirror) {
        part.only({"comment", "share", "reflectance", "grazing", "roughness"});
        s.colour = spectrum(part.at("reflectance"), 0, 1);
        for (float reflectance : s.colour.value)
            if (reflectance >= 1)
                part.at("reflectance").fail("must be less than 1: light would never end");
        s.grazing = part.has("grazing") ? spectrum(part.at("grazing"), 0, 1) : s.colour;
        if (auto roughness = part.find("roughness"))
            s.roughness = static_cast<float>(roughness->number(0, 1));
    } else {
        part.only({"comment", "share", "ior", "colour", "absorption", "thin"});
        s.ior = part.has("ior") ? part.at("ior").number(1, 4) : 1.5;
        s.colour = part.has("colour") ? spectrum(part.at("colour"), 0, 1) : Spectrum::constant(1);
        if (auto absorption = part.find("absorption"))
            s.absorption = spectrum(*absorption, 0, 1e15);
        s.thin = part.boolean_or("thin", false);
        m.two_sided = true;
    }
    if (s.share == 1) {
        for (const char* diffuse : {"reflectance", "transmittance", "back"})
            if (json.has(diffuse))
                json.at(diffuse).fail(
                    "the mirror or glass leaves nothing for a diffuse part; "
                    "give it a share below 1");
        m.reflectance = {};
    }
}

// A material is named, or numbered in the order of the list.
std::uint32_t ParalluxReader::material(const JsonView& json) const {
    if (!json.is_string()) {
        std::uint64_t i = json.count(none);
        if (i >= materials_.size())
            json.fail("no material " + std::to_string(i) + "; there are " +
                      std::to_string(materials_.size()));
        return static_cast<std::uint32_t>(i);
    }
    auto found = materials_.find(json.text());
    if (found == materials_.end())
        json.fail("no material \"" + printable(json.text()) + "\"");
    return found->second;
}

void ParalluxReader::read_lights() {
    auto list = root_.find("lights");
    double scale = scale_ * builder_.settings().scale;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
        JsonView json = list->at(i);
        json.only({"name", "comment", "type", "position", "direction", "intensity", "inner_cone",
                   "outer_cone", "range"});
        Light light;
        light.name = printable(json.text_or("name", "light " + std::to_string(i)));
        const std::string& type = json.at("type").text();
        if (type != "point" && type != "spot" && type != "directional")
            json.at("type").fail("must be point, spot or directional");
        light.kind = type == "point"  ? Light::Kind::point
                     : type == "spot" ? Light::Kind::spot
                                      : Light::Kind::directional;
        if (light.kind != Light::Kind::directional)
            light.position = json.at("position").vector() * scale;
        if (light.kind != Light::Kind::point)
            light.direction = direction(json.at("direction"));
        light.intensity = spectrum(json.at("intensity"), 0, 1e15);
        if (auto cone = json.find("outer_cone"))
            light.outer_cone = degrees(*cone, 0, 90);
        if (auto cone = json.find("inner_cone"))
            light.inner_cone = degrees(*cone, 0, 90);
        if (light.inner_cone > light.outer_cone)
            json.fail("inner_cone is more than outer_cone");
        if (auto range = json.find("range"))
            light.range = range->number(0, 1e15) * scale;
        scene_.lights.push_back(std::move(light));
    }
}

void ParalluxReader::read_cameras() {
    auto list = root_.find("cameras");
    double scale = scale_ * builder_.settings().scale;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
        JsonView json = list->at(i);
        json.only(
            {"name", "comment", "eye", "target", "up", "fov", "aspect", "orthographic_height"});
        Camera camera;
        camera.name = printable(json.text_or("name", "camera " + std::to_string(i)));
        glm::dvec3 eye = json.at("eye").vector(), target = json.at("target").vector();
        if (eye == target)
            json.fail("eye and target are one point");
        camera.position = eye * scale;
        camera.forward = glm::normalize(target - eye);
        glm::dvec3 up = json.has("up") ? direction(json.at("up")) : up_;
        glm::dvec3 right = glm::cross(camera.forward, up);
        if (!(glm::length(right) > 1e-9))
            json.fail("looks along its up; give another up");
        camera.up = glm::normalize(glm::cross(right, camera.forward));
        if (auto fov = json.find("fov"))
            camera.vertical_fov = degrees(*fov, 0.001, 179.9);
        if (auto aspect = json.find("aspect"))
            camera.aspect = aspect->number(0.001, 1000);
        if (auto height = json.find("orthographic_height"))
            camera.orthographic_height = height->number(1e-15, 1e15) * scale;
        scene_.cameras.push_back(std::move(camera));
    }
}

}  // namespace parallux
