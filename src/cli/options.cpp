#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/change_options.h"
#include "cli/method_options.h"
#include "cli/output_options.h"
#include "cli/reuse_options.h"
#include "cli/scene_options.h"
#include "cli/sky_options.h"
#include "cli/values.h"

namespace parallux {

namespace {

/// Help that names what an option takes; what it excludes is said when it is broken.
class ShortHelp : public CLI::Formatter {
public:
    ShortHelp() { column_width(26); }
    std::string make_option_opts(const CLI::Option* option) const override {
        return option->get_type_name().empty() ? "" : " " + option->get_type_name();
    }
};

/// Adds an option whose text a function reads; it throws Fault::usage when it does not like it.
CLI::Option* add(CLI::App& app, const std::string& name, const std::string& value,
                 const std::string& help, std::function<void(const std::string&)> read) {
    return app.add_option_function<std::string>(name, read, help)->type_name(value);
}

CLI::App* add_info(CLI::App& app, InfoOptions& o) {
    auto* info = app.add_subcommand("info", "Say what a scene holds");
    add_scene(*info, o.scene, o.load);
    info->add_flag("--json", o.json, "As one JSON object");
    const char* group = "Prediction";
    auto* predict = info->add_flag("--predict", o.predict,
                                   "Expected error of independent lines, before they are cast");
    predict->group(group);
    auto option = [&](const char* name, const char* value, const char* help,
                      std::function<void(const std::string&)> read) {
        add(*info, name, value, help, std::move(read))->needs(predict)->group(group);
    };
    o.solve.lines = 1'000'000;
    option("--lines", "N", "State the error of so many lines [1e6]",
           [&](auto& v) { o.solve.lines = parse_count("--lines", v, 1); });
    option("--error", "R", "State the lines for this relative RMS error [0.01]",
           [&](auto& v) { o.error = parse_positive("--error", v); });
    option("--sphere-radius", "R", "Of the lines, in the scene's units [around the scene]",
           [&](auto& v) { o.solve.sphere_radius = parse_positive("--sphere-radius", v); });
    option("--seed", "S", "Of the estimate [1]",
           [&](auto& v) { o.solve.seed = parse_count("--seed", v, 0); });
    option("--threads", "T", "0: all [0]", [&](auto& v) {
        o.solve.threads = static_cast<unsigned>(parse_count("--threads", v, 0, 4096));
    });
    add_patches(*info, o.patches);
    return info;
}

CLI::App* add_solve(CLI::App& app, SolveOptions& o) {
    auto* solve = app.add_subcommand("solve", "Solve a scene's radiosity; give the outputs wanted");
    add_scene(*solve, o.scene, o.load);
    add_changes(*solve, o);
    add_outputs(*solve, o);
    add_run_outputs(*solve, o);
    add_bakes(*solve, o);
    add_measurements(*solve, o);
    add_fluxes(*solve, o);
    add_patches(*solve, o.patches);
    add_method(*solve, o.solve);
    add_run(*solve, o);
    add_checkpoints(*solve, o);
    return solve;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& o) {
    auto* compare = app.add_subcommand("compare", "Say how two tables of one scene differ");
    compare->add_option("A", o.a, "Table to judge")->required()->type_name("FILE.csv");
    compare->add_option("B", o.b, "Table to judge it by")->required()->type_name("FILE.csv");
    add(*compare, "--tolerance", "T", "Exit with 1 when the relative RMS is above T",
        [&](auto& v) { o.tolerance = parse_real("--tolerance", v, 0, 1e15); });
    return compare;
}

}  // namespace

std::vector<std::filesystem::path> SolveOptions::outputs() const {
    std::vector<std::filesystem::path> files = images;
    files.insert(files.end(), bakes.begin(), bakes.end());
    files.insert(files.end(), object_lightmaps.begin(), object_lightmaps.end());
    const std::filesystem::path shared =
        lightmap_settings.by_object ? std::filesystem::path() : lightmap;
    for (const std::filesystem::path& file : {save, table, fluxes, sensor_table, stats, shared,
                                              lightmap_mesh(lightmap), solve.checkpoints.file})
        if (!file.empty())
            files.push_back(file);
    return files;
}

std::vector<std::filesystem::path> SolveOptions::inputs() const {
    std::vector<std::filesystem::path> files = {scene};
    // A run may go on in the checkpoint that it is taken up from.
    std::error_code ignored;
    const Checkpoints& kept = solve.checkpoints;
    const bool same = std::filesystem::equivalent(kept.file, kept.resume, ignored);
    for (const std::filesystem::path& file :
         {result, changes.materials, changes.temperatures, sensors,
          same ? std::filesystem::path() : kept.resume})
        if (!file.empty())
            files.push_back(file);
    return files;
}

Options parse_options(int argc, const char* const* argv) {
    Options options;
    CLI::App app("Parallux: how light and heat spread between diffuse surfaces.", "parallux");
    app.formatter(std::make_shared<ShortHelp>());  // before the subcommands, which inherit it
    app.set_version_flag("--version", std::string("parallux ") + PARALLUX_VERSION);
    app.require_subcommand(1);
    auto* info = add_info(app, options.info);
    auto* solve = add_solve(app, options.solve);
    auto* render = add_render(app, options.reuse);
    auto* bake = add_bake(app, options.reuse);
    add_compare(app, options.compare);
    auto* factors = add_factors(app, options.factors);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForVersion& version) {
        options.text = std::string(version.what()) + "\n";
        return options;
    } catch (const CLI::CallForHelp&) {
        options.text = app.help();
        return options;
    } catch (const CLI::ParseError& error) {
        auto chosen = app.get_subcommands();
        if (chosen.empty() && dynamic_cast<const CLI::RequiredError*>(&error))
            throw Error(
                Fault::usage,
                "expected info, solve, render, bake, factors or compare; try parallux --help");
        throw Error(Fault::usage, std::string(error.what()) + "; try parallux " +
                                      (chosen.empty() ? "" : chosen[0]->get_name() + " ") +
                                      "--help");
    }
    const bool reuse = render->parsed() || bake->parsed();
    options.command = info->parsed()      ? Command::info
                      : solve->parsed()   ? Command::solve
                      : reuse             ? Command::reuse
                      : factors->parsed() ? Command::factors
                                          : Command::compare;
    if (options.command == Command::solve) {
        options.solve.scene_arguments = scene_arguments(*solve);
        settle(options.solve);
    }
    if (reuse)  // settled when the result's own options are known
        options.reuse.scene_arguments = scene_arguments(render->parsed() ? *render : *bake);
    if (options.command == Command::factors)
        settle(options.factors);
    settle_sky(options.info.load.sky);
    for (double* length : {&options.info.patches.size, &options.info.solve.sphere_radius})
        *length *= options.info.load.scale;
    return options;
}

}  // namespace parallux
