#include "cli/change_options.h"

#include <functional>

#include "cli/values.h"

namespace parallux {

namespace {

constexpr double hottest = 1e5;

using Read = std::function<void(const std::string&)>;

CLI::Option* add(CLI::App& app, const char* group, const std::string& name,
                 const std::string& value, const std::string& help, Read read) {
    return app.add_option_function<std::string>(name, std::move(read), help)
        ->type_name(value)
        ->group(group);
}

}  // namespace

void add_changes(CLI::App& app, SolveOptions& o) {
    const char* group = "Scene";
    SceneChanges& c = o.changes;
    add(app, group, "--materials", "F.csv",
        "Values by material: material,reflectance_0 …,emission_0 … (W/m²)",
        [&](auto& v) { c.materials = parse_output("--materials", v); });
    add(app, group, "--bands", "K", "Bands, 1 to 8 [the scene's, or the materials' table's]",
        [&](auto& v) {
            c.bands = static_cast<std::uint32_t>(parse_count("--bands", v, 1, max_bands));
        });
    add(app, group, "--exclude", "NAMES",
        "Leave out objects or materials of these names, as a,b*; * is any text",
        [&](auto& v) { c.exclude = parse_names("--exclude", v); });
    auto* temperatures =
        add(app, group, "--temperatures", "F.csv",
            "Long-wave exchange: kind,name,temperature (K); kind all, material, object, surface "
            "or patch; emissivity is 1 - reflectance of band 0",
            [&](auto& v) { c.temperatures = parse_output("--temperatures", v); });
    add(app, group, "--sky-temperature", "K", "Of a uniform black sky around the scene [0]",
        [&](auto& v) { c.sky_temperature = parse_real("--sky-temperature", v, 0, hottest); })
        ->needs(temperatures);
}

void add_measurements(CLI::App& app, SolveOptions& o) {
    const char* group = "Outputs";
    add(app, group, "--receivers", "NAMES",
        "Only objects or materials of these names in the table; the others still take part",
        [&](auto& v) { o.receivers = parse_names("--receivers", v); });
    auto* sensors = add(app, group, "--sensors", "F.csv",
                        "Points that measure irradiance: x,y,z,nx,ny,nz and, if any, name",
                        [&](auto& v) { o.sensors = parse_output("--sensors", v); });
    auto* table = add(app, group, "--sensor-table", "FILE.csv", "What the sensors measure",
                      [&](auto& v) { o.sensor_table = parse_output("--sensor-table", v); });
    sensors->needs(table);
    table->needs(sensors);
    add(app, group, "--sensor-rays", "N", "A sensor [16384]", [&](auto& v) {
        o.sensing.rays = parse_count("--sensor-rays", v, 32, 1u << 28);
    })->needs(sensors);
    add(app, "Picture", "--band", "B|R,G,B",
        "Of PNG: one band in grey, or three in colour [all of scenes with one or three]",
        [&](auto& v) {
            o.picture.shown_bands.clear();
            for (const std::string& name : parse_names("--band", v))
                o.picture.shown_bands.push_back(
                    static_cast<std::uint32_t>(parse_count("--band", name, 0, max_bands - 1)));
            if (o.picture.shown_bands.size() != 1 && o.picture.shown_bands.size() != 3)
                refuse("--band", v, "expected one band or three");
        })
        ->needs("--image");
}

void add_fluxes(CLI::App& app, SolveOptions& o) {
    const char* group = "Outputs";
    auto* fluxes = add(app, group, "--fluxes", "FILE.csv",
                       "Net long-wave fluxes with --temperatures: incoming, outgoing, net",
                       [&](auto& v) { o.fluxes = parse_output("--fluxes", v); });
    add(app, group, "--fluxes-by", "UNIT",
        "A row for each patch, surface, object or material [object]",
        [&](auto& v) {
            o.flux_unit = parse_choice<FluxUnit>("--fluxes-by", v,
                                                 {{"patch", FluxUnit::patch},
                                                  {"surface", FluxUnit::surface},
                                                  {"object", FluxUnit::object},
                                                  {"material", FluxUnit::material}});
        })
        ->needs(fluxes);
}

void settle_changes(SolveOptions& o) {
    auto contradict = [](bool wrong, const char* what) {
        if (wrong)
            throw Error(Fault::usage, what);
    };
    const bool thermal = !o.changes.temperatures.empty();
    contradict(!o.receivers.empty() && o.table.empty(), "--receivers needs --table");
    contradict(!o.fluxes.empty() && !thermal, "--fluxes needs --temperatures");
    contradict(thermal && o.refresh > 0, "--refresh and --temperatures exclude each other");
    // All surfaces are sources then, and the error that is stated leaves sources out.
    contradict(thermal && o.solve.target_error > 0,
               "--target-error and --temperatures exclude each other; see the errors in --fluxes");
    const SkySettings& sky = o.load.sky;
    contradict(thermal && (sky.model != SkySettings::Model::from_file || sky.has_sun),
               "--sky and --sun exclude --temperatures; give --sky-temperature");
    contradict(thermal && o.changes.bands > 1, "--temperatures needs one band");
    // What all surfaces emit is found best along the same lines as what they reflect.
    if (thermal && o.solve.first_shot == FirstShot::automatic && o.solve.first_shot_rays == 0)
        o.solve.first_shot = FirstShot::off;
    o.sensing.seed = o.solve.seed;
    o.sensing.threads = o.solve.threads;
}

}  // namespace parallux
