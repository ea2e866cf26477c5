#include "cli/sky_options.h"

#include "cli/values.h"

namespace parallux {

namespace {

using Model = SkySettings::Model;

// "a:b:c" in its parts; an empty one is a part too.
std::vector<std::string> parts_of(const std::string& text, char between) {
    std::vector<std::string> parts(1);
    for (char c : text) {
        if (c == between)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

Spectrum grey(const std::string& option, const std::string& text, double high) {
    return Spectrum::constant(static_cast<float>(parse_real(option, text, 0, high)));
}

}  // namespace

void parse_sky(const std::string& option, const std::string& value, SkySettings& sky) {
    const std::size_t colon = value.find(':');
    sky.model = parse_choice<Model>(option, value.substr(0, colon),
                                    {{"dark", Model::dark},
                                     {"uniform", Model::uniform},
                                     {"overcast", Model::overcast},
                                     {"clear", Model::clear},
                                     {"perez", Model::perez},
                                     {"image", Model::image}});
    const std::string rest = colon == value.npos ? "" : value.substr(colon + 1);
    if (sky.model == Model::dark && colon == value.npos)
        return;
    if (rest.empty())
        refuse(option, value, "expected a value or a file after the colon");
    if (sky.model == Model::image) {
        sky.image = rest;
        return;
    }
    const std::vector<std::string> parts = parts_of(rest, ':');
    if (parts.size() > 2 || sky.model == Model::dark)
        refuse(option, value, "expected SKY:VALUE or SKY:VALUE:ALBEDO");
    (sky.model == Model::perez ? sky.diffuse : sky.radiance) = grey(option, parts[0], 1e15);
    sky.has_ground = parts.size() == 2;
    if (sky.has_ground)
        sky.albedo = grey(option, parts[1], 1);
}

void parse_sun(const std::string& option, const std::string& value, SkySettings& sky) {
    const std::vector<std::string> parts = parts_of(value, ',');
    if (parts.size() < 2 || parts.size() > 3)
        refuse(option, value, "expected ELEVATION,AZIMUTH or ELEVATION,AZIMUTH,DIRECT");
    sky.has_sun = true;
    sky.elevation = parse_real(option, parts[0], 0, 90) * pi / 180;
    sky.azimuth = parse_real(option, parts[1], -360, 360) * pi / 180;
    if (parts.size() == 3)
        sky.direct = grey(option, parts[2], 1e15);
}

std::array<double, 2> parse_period(const std::string& option, const std::string& value) {
    const std::vector<std::string> parts = parts_of(value, ',');
    if (parts.size() != 2)
        refuse(option, value, "expected X,Y");
    std::array<double, 2> period;
    for (std::size_t k = 0; k < 2; ++k)
        period[k] = parse_real(option, parts[k], 0, 1e15);
    if (period[0] == 0 && period[1] == 0)
        refuse(option, value, "expected one of them to be more than 0");
    return period;
}

void settle_sky(const SkySettings& sky) {
    if ((sky.model == Model::clear || sky.model == Model::perez) && !sky.has_sun)
        throw Error(Fault::usage, "--sky clear and --sky perez need --sun");
}

}  // namespace parallux
