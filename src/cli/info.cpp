#include "cli/info.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/prediction.h"
#include "cli/terminal.h"
#include "parallux/tables.h"

namespace parallux {

namespace {

using Json = nlohmann::ordered_json;

/// The surfaces that emit, and what they emit: area × factor × sides. A texture or a vertex colour
/// can only lower it, so then it is an upper bound.
Json emitters(const Scene& scene) {
    std::uint64_t surfaces = 0;
    std::vector<double> power(scene.bands, 0);
    bool bound = false;
    for (const Surface& surface : scene.surfaces) {
        const Material& material = scene.materials.at(surface.material);
        if (material.emission == Spectrum{})
            continue;
        ++surfaces;
        bound = bound || material.emission_texture != none || !scene.attributes.empty();
        double area = surface_area(scene, surface) * (material.two_sided ? 2 : 1);
        for (std::uint32_t band = 0; band < scene.bands; ++band)
            power[band] += area * static_cast<double>(material.emission[band]);
    }
    return {{"surfaces", surfaces}, {"power", power}, {"power_is_upper_bound", bound}};
}

Json lights(const Scene& scene) {
    static constexpr const char* kinds[] = {"point", "spot", "directional"};
    Json result = Json::array();
    for (const Light& light : scene.lights)
        result.push_back({{"name", light.name}, {"kind", kinds[static_cast<int>(light.kind)]}});
    return result;
}

Json cameras(const Scene& scene) {
    Json result = Json::array();
    for (const Camera& camera : scene.cameras)
        result.push_back(camera.name);
    return result;
}

Json describe(const Scene& scene) {
    static constexpr const char* skies[] = {"dark", "uniform", "gradient", "image", "shaped"};
    double area = 0;
    std::uint64_t parallelograms = 0, curved = 0;
    for (const Surface& surface : scene.surfaces) {
        area += surface_area(scene, surface);
        curved += surface.is_curved();
        parallelograms += !surface.is_curved() && surface.shape() == Shape::parallelogram;
    }
    const Bounds bounds = scene_bounds(scene);
    Json info;
    info["scene"] = scene.file.string();
    info["surfaces"] = scene.surfaces.size();
    info["parallelograms"] = parallelograms;
    info["curved"] = curved;
    info["triangles"] = scene.triangles;
    info["zero_area"] = scene.zero_area;
    info["materials"] = scene.materials.size();
    info["bands"] = scene.bands;
    info["emitters"] = emitters(scene);
    info["area"] = area;
    info["bounds"] = {{"low", {bounds.low.x, bounds.low.y, bounds.low.z}},
                      {"high", {bounds.high.x, bounds.high.y, bounds.high.z}}};
    info["closed"] = is_closed(scene);
    info["cameras"] = cameras(scene);
    info["lights"] = lights(scene);
    info["sky"] = skies[static_cast<int>(scene.sky.kind)];
    info["warnings"] = scene.warnings;
    return info;
}

std::string numbers(const Json& list, const char* between) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    for (std::size_t i = 0; i < list.size(); ++i)
        text << (i ? between : "") << list[i].get<double>();
    return text.str();
}

std::string names(const Json& list) {
    std::string text = std::to_string(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Json& item = list[i];
        std::string name = item.is_object() ? item["kind"].get<std::string>() + " " +
                                                  item["name"].get<std::string>()
                                            : item.get<std::string>();
        text += (i ? ", " : ": ") + (name.empty() ? "(no name)" : printable(name));
    }
    return text;
}

std::string for_people(const Json& info) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    auto row = [&](const char* label) -> std::ostream& {
        std::string padded(label);
        padded.resize(15, ' ');
        return text << padded;
    };
    const Json& emitters = info["emitters"];
    row("scene") << printable(info["scene"].get<std::string>()) << '\n';
    row("surfaces") << info["surfaces"] << " (" << info["parallelograms"] << " parallelograms";
    if (info["curved"] > 0)
        text << ", " << info["curved"] << " curved";
    text << ")\n";
    row("triangles") << info["triangles"] << " (" << info["zero_area"]
                     << " of zero area dropped)\n";
    row("materials") << info["materials"] << '\n';
    row("bands") << info["bands"] << '\n';
    row("emitters") << emitters["surfaces"] << " surfaces, "
                    << (emitters["power_is_upper_bound"] ? "at most " : "")
                    << numbers(emitters["power"], " / ") << " W per band\n";
    row("area") << info["area"].get<double>() << " m²\n";
    row("bounds") << '(' << numbers(info["bounds"]["low"], ", ") << ") to ("
                  << numbers(info["bounds"]["high"], ", ") << ") m\n";
    row("closed") << (info["closed"].get<bool>() ? "yes" : "no: some edges have an open side")
                  << '\n';
    row("cameras") << names(info["cameras"]) << '\n';
    row("lights") << names(info["lights"]) << '\n';
    row("sky") << info["sky"].get<std::string>() << '\n';
    for (const Json& warning : info["warnings"])
        row("warning") << printable(warning.get<std::string>()) << '\n';
    return text.str();
}

}  // namespace

std::string describe_scene(const Scene& scene, const InfoOptions& options) {
    Json info = describe(scene);
    if (options.predict)
        info["prediction"] = predict_lines(scene, options);
    // Names may hold any bytes; JSON may not.
    if (options.json)
        return info.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    return for_people(info) + (options.predict ? prediction_text(info["prediction"]) : "");
}

}  // namespace parallux
