#include <cmath>

#include <glm/geometric.hpp>

#include "scene/input.h"
#include "scene/parallux_json.h"
#include "scene/sky_models.h"
#include "scene/textures.h"

namespace parallux {
namespace {

using Model = SkySettings::Model;

double degrees(const JsonView& json, double low, double high) {
    return json.number(low, high) * pi / 180;
}

}  // namespace

void ParalluxReader::read_sky() {
    Sky& sky = scene_.sky;
    sky.up = up_;
    auto json = root_.find("sky");
    if (!json)
        return;
    json->only({"comment", "uniform", "gradient", "image", "overcast", "clear", "perez", "scale",
                "north", "sun", "albedo"});
    int models = 0;
    for (const char* key : {"uniform", "gradient", "image", "overcast", "clear", "perez"})
        models += json->has(key);
    if (models > 1 || (models == 0 && !json->has("sun")))
        json->fail(
            "must have one of uniform, gradient, image, overcast, clear and perez, or a sun");
    if (auto north = json->find("north")) {
        sky.north = direction(*north);
        if (std::abs(glm::dot(sky.north, up_)) > 0.999)
            north->fail("lies along up");
    } else if (std::abs(glm::dot(sky.north, up_)) > 0.999) {
        sky.north = {0, 0, -1};  // with y up
    }
    const bool drawn = read_drawn_sky(*json);
    if (drawn && json->has("albedo"))
        json->at("albedo").fail("is for uniform, overcast, clear and perez skies alone");
    if (auto wrong = put_sky(scene_, read_sky_model(*json)))
        json->fail(*wrong);
}

void ParalluxReader::read_period() {
    auto json = root_.find("periodic");
    if (!json)
        return;
    json->only({"comment", "x", "y"});
    if (has_curves(scene_))
        json->fail("scenes with curved surfaces do not repeat");
    const double scale = scale_ * builder_.settings().scale;
    int count = 0;
    for (const char* key : {"x", "y"})
        if (auto vector = json->find(key))
            scene_.period[count++] = vector->vector() * scale;
    if (count == 0)
        json->fail("must have x, y or both");
    if (auto wrong = settle_period(scene_))
        json->fail(*wrong);
}

// Skies that the file draws itself.
bool ParalluxReader::read_drawn_sky(const JsonView& json) {
    Sky& sky = scene_.sky;
    if (auto gradient = json.find("gradient")) {
        gradient->only({"comment", "zenith", "horizon", "ground"});
        sky.kind = Sky::Kind::gradient;
        sky.zenith = spectrum(gradient->at("zenith"), 0, 1e15);
        sky.horizon = spectrum(gradient->at("horizon"), 0, 1e15);
        if (auto ground = gradient->find("ground"))
            sky.ground = spectrum(*ground, 0, 1e15);
        return true;
    }
    auto image = json.find("image");
    if (!image)
        return false;
    if (scene_.bands != 3)
        image->fail("an image has three bands; give uniform or gradient per band");
    auto file = resolve_below(scene_.file, image->path(), image->text());
    sky.kind = Sky::Kind::image;
    sky.image = decode_picture(file, "", read_file(file), max_texels);
    sky.image.name = printable(image->text());
    if (auto scale = json.find("scale"))
        sky.scale = static_cast<float>(scale->number(0, 1e15));
    return true;
}

// Skies by a model, the sun of any sky, and the ground.
SkySettings ParalluxReader::read_sky_model(const JsonView& json) const {
    SkySettings settings;
    if (auto uniform = json.find("uniform")) {
        settings.model = Model::uniform;
        settings.radiance = spectrum(*uniform, 0, 1e15);
    } else if (auto overcast = json.find("overcast")) {
        settings.model = Model::overcast;
        settings.radiance = spectrum(*overcast, 0, 1e15);
    } else if (auto clear = json.find("clear")) {
        settings.model = Model::clear;
        settings.radiance = spectrum(*clear, 0, 1e15);
    } else if (auto perez = json.find("perez")) {
        settings.model = Model::perez;
        settings.diffuse = spectrum(*perez, 0, 1e15);
    } else if (json.has("albedo")) {
        settings.model = Model::dark;  // ground that the sun alone lights
    }
    if (auto sun = json.find("sun")) {
        sun->only({"comment", "elevation", "azimuth", "direct"});
        settings.has_sun = true;
        settings.elevation = degrees(sun->at("elevation"), 0, 90);
        settings.azimuth = degrees(sun->at("azimuth"), -360, 360);
        if (auto direct = sun->find("direct"))
            settings.direct = spectrum(*direct, 0, 1e15);
    }
    if (auto albedo = json.find("albedo")) {
        settings.has_ground = true;
        settings.albedo = spectrum(*albedo, 0, 1);
    }
    return settings;
}

}  // namespace parallux
