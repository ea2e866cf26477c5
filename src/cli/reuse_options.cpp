#include "cli/reuse_options.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "cli/change_options.h"
#include "cli/method_options.h"
#include "cli/options.h"
#include "cli/output_options.h"
#include "cli/scene_options.h"

namespace parallux {

namespace {

CLI::App* add_reuse(CLI::App& app, const char* name, const char* help, SolveOptions& o) {
    auto* reuse = app.add_subcommand(name, help);
    reuse->add_option("RESULT", o.result, "What solve --save has written")
        ->required()
        ->type_name("FILE.plx");
    add_scene(*reuse, o.scene, o.load);
    add_changes(*reuse, o);
    add_outputs(*reuse, o);
    add_bakes(*reuse, o);
    add_measurements(*reuse, o);
    add_workers(*reuse, o);
    reuse->footer(
        "The result knows the options of Scene and Patches that it was solved with. Give one again "
        "only where a file that it names has moved; a scene that comes out otherwise is refused.");
    return reuse;
}

// Reads arguments of scene_arguments() into the options.
void replay(std::vector<std::string> arguments, SolveOptions& o) {
    CLI::App app;
    app.set_help_flag();
    std::filesystem::path scene = o.scene;
    add_scene(app, scene, o.load);
    add_changes(app, o);
    add_patches(app, o.patches);
    bool own_uv = false;
    app.add_flag("--read-lightmap-uv", own_uv);
    arguments.push_back("scene");
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    app.parse(arguments);
    o.load.lightmap_uv = o.load.lightmap_uv || own_uv;
}

}  // namespace

CLI::App* add_render(CLI::App& app, SolveOptions& options) {
    return add_reuse(app, "render",
                     "Draw pictures of a result of solve --save, or its other outputs", options);
}

CLI::App* add_bake(CLI::App& app, SolveOptions& options) {
    return add_reuse(app, "bake", "Bake a result of solve --save, or write its other outputs",
                     options);
}

std::vector<std::string> scene_arguments(const CLI::App& parsed) {
    std::vector<std::string> arguments;
    for (const CLI::Option* option : parsed.get_options()) {
        const bool scene = option->get_group() == "Scene" || option->get_group() == "Patches";
        // How triangles are joined depends on whether these coordinates are read.
        if (option->count() > 0 && option->check_name("--lightmap-uv") &&
            option->results().back() != "pack")
            arguments.push_back("--read-lightmap-uv");
        if (!scene || option->count() == 0 || option->get_positional())
            continue;
        arguments.push_back(option->get_name());
        if (option->get_expected_min() > 0)
            arguments.push_back(option->results().back());
    }
    return arguments;
}

void recall(const SavedSolution& result, SolveOptions& options) {
    try {
        replay(result.arguments, options);
    } catch (const std::exception&) {
        throw Error(Fault::input, options.result.string() +
                                      ": damaged: options that are none; solve again with --save");
    }
    replay(options.scene_arguments, options);
    options.solve.method = result.settings.method;
    options.solve.seed = result.settings.seed;
    options.solve.target_error = result.settings.target_error;
    settle(options);
}

}  // namespace parallux
