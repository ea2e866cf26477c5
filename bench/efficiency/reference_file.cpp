#include "efficiency/reference_file.h"

#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "parallux/error.h"
#include "random.h"

namespace parallux::efficiency {

namespace {

using Json = nlohmann::ordered_json;

// Raised when references are made in another way, so that no older one is taken for one of these.
constexpr std::uint64_t version = 3;

std::string key_of(const Case& of, const ReferenceSettings& settings) {
    char text[17];
    const std::uint64_t key = mix64(mix64(of.fingerprint + version) ^ settings.bundles);
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(key));
    return text;
}

std::filesystem::path file_of(const Case& of, const ReferenceSettings& settings) {
    const std::string name = std::filesystem::path(of.name).filename().string();
    return settings.folder / (name + "-" + key_of(of, settings) + ".json");
}

Json json_of(const Check& check) {
    return Json::array({check.difference, check.expected, check.bound});
}

Check check_of(const Json& json) {
    return {json.at(0), json.at(1), json.at(2)};
}

void fill(const Json& json, Reference& reference) {
    json.at("radiosity").get_to(reference.radiosity);
    json.at("scale").get_to(reference.scale);
    json.at("stated").get_to(reference.stated);
    json.at("bound").get_to(reference.bound);
    json.at("own_error").get_to(reference.own_error);
    reference.rays = check_of(json.at("rays"));
    reference.exact = check_of(json.at("exact"));
    for (const Json& run : json.at("runs"))
        reference.runs.push_back({run.at("first_shot"), run.at("seed"), run.at("bundles"),
                                  run.at("relative_rms"), run.at("relative_rms_bound"),
                                  run.at("seconds")});
}

}  // namespace

bool read_reference(const Case& of, const ReferenceSettings& settings, Reference& reference) {
    const std::filesystem::path file = file_of(of, settings);
    std::ifstream input(file);
    if (!input)
        return false;
    try {
        const Json json = Json::parse(input);
        fill(json, reference);
        reference.cached = true;
        if (json.at("key") == key_of(of, settings) &&
            reference.radiosity.size() == of.patches.reflectance.size())
            return true;
    } catch (const nlohmann::json::exception&) {
    }
    std::printf("%s is not a reference of this case; it is made anew\n", file.c_str());
    reference = {};
    return false;
}

void write_reference(const Case& of, const ReferenceSettings& settings,
                     const Reference& reference) {
    std::error_code failed;
    std::filesystem::create_directories(settings.folder, failed);
    if (failed)
        throw Error(Fault::output, settings.folder.string() + ": " + failed.message());
    Json runs = Json::array();
    for (const LongRun& run : reference.runs)
        runs.push_back({{"first_shot", run.first_shot},
                        {"seed", run.seed},
                        {"bundles", run.bundles},
                        {"relative_rms", run.relative_rms},
                        {"relative_rms_bound", run.relative_rms_bound},
                        {"seconds", run.seconds}});
    const Json json{{"key", key_of(of, settings)},     {"scene", of.name},
                    {"patches", of.patches.count()},   {"runs", runs},
                    {"scale", reference.scale},        {"stated", reference.stated},
                    {"bound", reference.bound},        {"own_error", reference.own_error},
                    {"rays", json_of(reference.rays)}, {"exact", json_of(reference.exact)},
                    {"radiosity", reference.radiosity}};
    OutputFile output(file_of(of, settings));
    output.write(json.dump() + "\n");
    output.commit();
}

}  // namespace parallux::efficiency
