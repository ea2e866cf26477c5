#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/change_options.h"
#include "cli/sky_options.h"
#include "cli/values.h"
#include "vectors.h"

namespace parallux {

namespace {

constexpr std::uint64_t count_32 = 0xffffffffu;

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

/// What the program will do one day but cannot do yet is refused, never ignored.
[[noreturn]] void not_available(const std::string& what) {
    throw Error(Fault::usage, what + " is not available in this version");
}

void add_unavailable(CLI::App& app) {
    for (std::string name : {"--checkpoint", "--resume"})
        app.add_option_function<std::vector<std::string>>(
               name, [name](const std::vector<std::string>&) { not_available(name); })
            ->expected(0, 1)
            ->group("");
}

Method parse_method(const std::string& value) {
    return parse_choice<Method>("--method", value,
                                {{"bundles", Method::bundles},
                                 {"lines", Method::lines},
                                 {"progressive", Method::progressive},
                                 {"particles", Method::particles},
                                 {"matrix", Method::matrix}});
}

FirstShot parse_first_shot(const std::string& value) {
    return parse_choice<FirstShot>(
        "--first-shot", value,
        {{"none", FirstShot::off}, {"rays", FirstShot::rays}, {"exact", FirstShot::exact}});
}

std::filesystem::path parse_output(const std::string& option, const std::string& value) {
    if (value.empty() || value.starts_with("--"))
        refuse(option, value, "expected a file name");
    return value;
}

std::filesystem::path parse_image(const std::string& value) {
    std::filesystem::path file = parse_output("--image", value);
    if (file.extension() != ".exr" && file.extension() != ".png")
        refuse("--image", value, "expected a name that ends in .exr or .png");
    return file;
}

std::filesystem::path parse_bake(const std::string& value) {
    std::filesystem::path file = parse_output("--bake", value);
    if (file.extension() != ".glb" && file.extension() != ".gltf" && file.extension() != ".ply")
        refuse("--bake", value, "expected a name that ends in .glb, .gltf or .ply");
    return file;
}

std::filesystem::path parse_lightmap(const std::string& value) {
    std::filesystem::path file = parse_output("--lightmap", value);
    if (file.extension() != ".exr")
        refuse("--lightmap", value, "expected a name that ends in .exr");
    return file;
}

void add_scene(CLI::App& app, std::filesystem::path& scene, LoadSettings& load) {
    app.add_option("SCENE", scene, "glTF (.gltf, .glb), OBJ, STL or Parallux (.json) scene")
        ->required()
        ->type_name("");
    add(app, "--scale", "X", "Metres per unit of the scene file [1]", [&](auto& v) {
        load.scale = parse_positive("--scale", v);
    })->group("Scene");
    add(app, "--reflectance", "R", "Of faces without a material, as in STL, 0 to 0.999 [0.5]",
        [&](auto& v) {
            load.reflectance =
                Spectrum::constant(static_cast<float>(parse_real("--reflectance", v, 0, 0.999)));
        })
        ->group("Scene");
    add(app, "--sky", "SKY",
        "In place of the scene's: dark, uniform:L, overcast:L, clear:L (radiance, at the zenith, "
        "W/(m² sr)), perez:D (diffuse horizontal W/m²), image:FILE; with :ALBEDO, as in "
        "perez:120:0.2, ground that it and the sun light",
        [&](auto& v) { parse_sky("--sky", v, load.sky); })
        ->group("Scene");
    add(app, "--periodic", "X,Y",
        "The scene repeats without end after so many of its units along x and y (z where y is up); "
        "0: not that way",
        [&](auto& v) { load.period = parse_period("--periodic", v); })
        ->group("Scene");
    add(app, "--sun", "H,AZ[,D]",
        "In place of the scene's: elevation, azimuth from north by east (degrees), direct W/m² [0]",
        [&](auto& v) { parse_sun("--sun", v, load.sky); })
        ->group("Scene");
}

void add_outputs(CLI::App& app, SolveOptions& o) {
    PictureSettings& picture = o.picture;
    // One file an option: a list would swallow the scene's name.
    auto* image = app.add_option_function<std::vector<std::string>>(
        "--image",
        [&](const std::vector<std::string>& values) {
            for (const std::string& value : values)
                o.images.push_back(parse_image(value));
        },
        "Picture: .exr (linear, all layers) or .png (as the eye sees it); repeatable");
    image->type_name("FILE")->allow_extra_args(false)->group("Outputs");
    add(app, "--table", "FILE.csv", "One row a patch: place, area, radiosity, irradiance …",
        [&](auto& v) { o.table = parse_output("--table", v); })
        ->group("Outputs");
    add(app, "--stats", "FILE.json", "Counts, seconds, energy balance, hash of the run",
        [&](auto& v) { o.stats = parse_output("--stats", v); })
        ->group("Outputs");

    auto of_picture = [&](CLI::Option* option) { option->needs(image)->group("Picture"); };
    of_picture(app.add_option("--camera", o.camera, "By name or index [the first]")
                   ->type_name("NAME|INDEX"));
    of_picture(
        add(app, "--size", "WxH", "Pixels; W alone takes the camera's aspect [1024]",
            [&](auto& v) { std::tie(picture.width, picture.height) = parse_size("--size", v); }));
    add(app, "--exposure", "EV", "Stops on top of the automatic exposure of PNG and --unlit [0]",
        [&](auto& v) { picture.exposure = o.bake.exposure = parse_real("--exposure", v, -64, 64); })
        ->group("Picture");
    of_picture(add(app, "--tone", "CURVE", "Of PNG: filmic or clamp [filmic]", [&](auto& v) {
        picture.filmic = parse_choice<bool>("--tone", v, {{"filmic", true}, {"clamp", false}});
    }));
    of_picture(add(app, "--samples", "N", "Camera rays a pixel [16]", [&](auto& v) {
        picture.samples = static_cast<std::uint32_t>(parse_count("--samples", v, 1, 65536));
    }));
    of_picture(
        add(app, "--refresh", "S",
            "Rewrite the pictures while the run goes on, with what the groups of bundles done "
            "so far come to, at most every S seconds [off]",
            [&](auto& v) { o.refresh = parse_positive("--refresh", v); }));
    app.add_flag("--flat", picture.flat, "Show the patches unsmoothed, in bakes as well")
        ->group("Picture");
}

void add_bakes(CLI::App& app, SolveOptions& o) {
    auto* bake = app.add_option_function<std::vector<std::string>>(
        "--bake",
        [&](const std::vector<std::string>& values) {
            for (const std::string& value : values)
                o.bakes.push_back(parse_bake(value));
        },
        "Vertex colours: .glb, .gltf (COLOR_0) or .ply; repeatable");
    bake->type_name("FILE")->allow_extra_args(false)->group("Outputs");
    auto* lightmap = add(app, "--lightmap", "FILE.exr",
                         "A texel a patch, and beside it FILE.glb with TEXCOORD_1 into it",
                         [&](auto& v) { o.lightmap = parse_lightmap(v); });
    lightmap->group("Outputs");

    const char* group = "Bake";
    add(app, "--bake-mesh", "M", "original, or patches: a face a patch [original]",
        [&](auto& v) {
            o.bake.mesh = parse_choice<BakeMesh>(
                "--bake-mesh", v,
                {{"original", BakeMesh::original}, {"patches", BakeMesh::patches}});
        })
        ->needs(bake)
        ->group(group);
    add(app, "--quantity", "Q", "irradiance, radiosity or radiance [radiosity]", [&](auto& v) {
        o.bake.quantity = o.lightmap_settings.quantity =
            parse_choice<Quantity>("--quantity", v,
                                   {{"irradiance", Quantity::irradiance},
                                    {"radiosity", Quantity::radiosity},
                                    {"radiance", Quantity::radiance}});
    })->group(group);
    app.add_flag("--unlit", o.bake.unlit,
                 "Ready to view: exposed, clamped to 1, KHR_materials_unlit")
        ->needs(bake)
        ->group(group);
    add(app, "--lightmap-uv", "UV",
        "pack (a chart a surface), or own: the TEXCOORD_1 of a glTF scene [pack]",
        [&](auto& v) {
            o.lightmap_settings.own_uv = o.load.lightmap_uv =
                parse_choice<bool>("--lightmap-uv", v, {{"pack", false}, {"own", true}});
        })
        ->needs(lightmap)
        ->group(group);
    add(app, "--lightmap-size", "N", "Texels wide and high [a texel a patch; with own 1024]",
        [&](auto& v) {
            o.lightmap_settings.size =
                static_cast<std::uint32_t>(parse_count("--lightmap-size", v, 8, 65536));
        })
        ->needs(lightmap)
        ->group(group);
}

void add_patches(CLI::App& app, PatchSettings& patches) {
    const char* group = "Patches";
    auto* size = add(app, "--patch-size", "L", "Wanted side, in the scene's units",
                     [&](auto& v) { patches.size = parse_positive("--patch-size", v); });
    auto* count = add(app, "--patches", "N", "Wanted number in all [10000]",
                      [&](auto& v) { patches.count = parse_count("--patches", v, 1, 0x7fffffff); });
    size->excludes(count)->group(group);
    count->group(group);
    app.add_flag_callback(
           "--no-clusters", [&] { patches.clusters = false; },
           "Give every fine triangle a patch of its own")
        ->group(group);
}

void add_method(CLI::App& app, SolveSettings& s) {
    const char* group = "Method";
    auto option = [&](const char* name, const char* value, const char* help,
                      std::function<void(const std::string&)> read) {
        return add(app, name, value, help, std::move(read))->group(group);
    };
    option(
        "--method", "M",
        "bundles (of parallel lines), lines (independent, one after the other), or for comparison "
        "progressive, particles, matrix [bundles]",
        [&](auto& v) { s.method = parse_method(v); });
    option("--direction", "D", "bidirectional or oriented exchange [bidirectional]", [&](auto& v) {
        s.direction = parse_choice<Direction>(
            "--direction", v,
            {{"bidirectional", Direction::bidirectional}, {"oriented", Direction::oriented}});
    });
    option(
        "--first-shot", "F",
        "Direct light by rays, exact (form factors; emitters × patches), or none [exact in scenes "
        "of few surfaces and sources, else rays]",
        [&](auto& v) { s.first_shot = parse_first_shot(v); });
    option("--first-shot-rays", "N",
           "Rays of the first shot; with --target-error of its first round, more in proportion in "
           "longer ones [grows with the lines]",
           [&](auto& v) { s.first_shot_rays = parse_count("--first-shot-rays", v, 1); });
    option("--shots", "N", "Then so many more, from the patches with most unshot power [0]",
           [&](auto& v) { s.shots = parse_count("--shots", v, 0); });
    auto* bundles = option("--bundles", "D", "Directions of parallel lines [4096]",
                           [&](auto& v) { s.bundles = parse_count("--bundles", v, 1); });
    auto* lines =
        option("--lines", "N", "Lines in all, rays or particles of the methods that send those",
               [&](auto& v) { s.lines = parse_count("--lines", v, 1); });
    lines->excludes(bundles);
    option(
        "--target-error", "R",
        "Run until the relative RMS is below this with 95 % confidence, as 0.01; exit with 1 when "
        "that is not reached",
        [&](auto& v) { s.target_error = parse_real("--target-error", v, 1e-6, 1); })
        ->excludes(bundles)
        ->excludes(lines);
    auto* spacing = option("--line-spacing", "L", "Between a bundle's lines, in the scene's units",
                           [&](auto& v) { s.line_spacing = parse_positive("--line-spacing", v); });
    option(
        "--lines-per-patch", "C",
        "Lines of a bundle over a mean patch's area [4 with 1500 bundles a group, more with more]",
        [&](auto& v) { s.lines_per_patch = parse_positive("--lines-per-patch", v); })
        ->excludes(spacing);
    option("--gather-share", "S", "Of the bundles, that gather once the others have passed [0.7]",
           [&](auto& v) { s.gather_share = parse_real("--gather-share", v, 0, 1); });
    option(
        "--groups", "R",
        "Independent parts of the bundles, whose spread tells the error; 1: unknown [8 with 800 "
        "bundles or more]",
        [&](auto& v) { s.groups = static_cast<std::uint32_t>(parse_count("--groups", v, 1, 64)); });
    option("--directions", "D", "lattice or random [lattice]", [&](auto& v) {
        s.directions = parse_choice<DirectionSet>(
            "--directions", v,
            {{"lattice", DirectionSet::lattice}, {"random", DirectionSet::random}});
    });
    option(
        "--batch", "B",
        "Bundles, or as many lines, from one snapshot; part of the result [bundles up to 16, lines "
        "one by one]",
        [&](auto& v) {
            s.batch = static_cast<std::uint32_t>(parse_count("--batch", v, 1, count_32));
        });
    option("--sphere-radius", "R", "Of independent lines, in the scene's units [around the scene]",
           [&](auto& v) { s.sphere_radius = parse_positive("--sphere-radius", v); });
    option("--seed", "S", "Equal seeds give equal results, whatever the threads [1]",
           [&](auto& v) { s.seed = parse_count("--seed", v, 0); });
}

void add_run(CLI::App& app, SolveOptions& o) {
    const char* group = "Run";
    add(app, "--threads", "T", "0: all [0]", [&](auto& v) {
        o.solve.threads = static_cast<unsigned>(parse_count("--threads", v, 0, 4096));
        o.picture.threads = o.bake.threads = o.lightmap_settings.threads = o.solve.threads;
    })->group(group);
    add(app, "--vectors", "SET",
        "Instruction set: auto, plain, sse4, avx2 or avx512; part of the speed alone [auto]",
        [&](auto& v) {
            if (!use_vectors(v.c_str()))
                refuse("--vectors", v,
                       "expected auto, plain, sse4, avx2 or avx512, as far as this "
                       "machine has them");
        })
        ->group(group);
    add(app, "--max-memory", "M", "Refuse to start a solve above this: 500M, 4GiB [no limit]",
        [&](auto& v) { o.solve.max_memory = parse_bytes("--max-memory", v); })
        ->group(group);
    add(app, "--time-limit", "S", "Seconds after which to stop with a partial result [none]",
        [&](auto& v) { o.solve.time_limit = parse_positive("--time-limit", v); })
        ->group(group);
    add(app, "--progress", "P", "auto, on (a bar), off, or json (one object a line) [auto]",
        [&](auto& v) {
            o.progress = parse_choice<ProgressMode>("--progress", v,
                                                    {{"auto", ProgressMode::automatic},
                                                     {"on", ProgressMode::on},
                                                     {"off", ProgressMode::off},
                                                     {"json", ProgressMode::json}});
        })
        ->group(group);
    app.add_flag("--quiet", o.quiet, "No progress, summary or warnings; failures are still told")
        ->group(group);
}

/// What single options cannot know of each other. Lengths become metres here, when --scale is read.
void settle(SolveOptions& o) {
    auto contradict = [](bool wrong, const char* what) {
        if (wrong)
            throw Error(Fault::usage, what);
    };
    contradict(o.quiet && o.progress == ProgressMode::on,
               "--quiet and --progress on exclude each other");
    bool shot_by_rays =
        o.solve.first_shot == FirstShot::rays || o.solve.first_shot == FirstShot::automatic;
    contradict(!shot_by_rays && o.solve.first_shot_rays > 0,
               "--first-shot-rays needs --first-shot rays");
    contradict(o.refresh > 0 && (o.solve.method != Method::bundles || o.solve.groups == 1),
               "--refresh needs --method bundles and more than one group");
    bool independent = o.solve.method == Method::lines || o.solve.method == Method::matrix;
    contradict(!independent && o.solve.sphere_radius > 0,
               "--sphere-radius needs --method lines or matrix");
    const bool bakes = !o.bakes.empty() || !o.lightmap.empty();
    contradict(o.picture.exposure != 0 && o.images.empty() && !o.bake.unlit,
               "--exposure needs --image, or --bake with --unlit");
    contradict(o.picture.flat && o.images.empty() && !bakes,
               "--flat needs --image, --bake or --lightmap");
    contradict(o.bake.quantity != Quantity::radiosity && !bakes,
               "--quantity needs --bake or --lightmap");
    o.bake.flat = o.lightmap_settings.flat = o.picture.flat;
    settle_sky(o.load.sky);
    if (o.quiet && o.progress == ProgressMode::automatic)
        o.progress = ProgressMode::off;
    settle_changes(o);
    for (double* length : {&o.patches.size, &o.solve.line_spacing, &o.solve.sphere_radius})
        *length *= o.load.scale;
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
    add_bakes(*solve, o);
    add_measurements(*solve, o);
    add_patches(*solve, o.patches);
    add_method(*solve, o.solve);
    add_run(*solve, o);
    add_unavailable(*solve);
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
    for (const std::filesystem::path& file :
         {table, fluxes, sensor_table, stats, lightmap, lightmap_mesh(lightmap)})
        if (!file.empty())
            files.push_back(file);
    return files;
}

std::vector<std::filesystem::path> SolveOptions::inputs() const {
    std::vector<std::filesystem::path> files = {scene};
    for (const std::filesystem::path& file : {changes.materials, changes.temperatures, sensors})
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
            throw Error(Fault::usage,
                        "expected info, solve, factors or compare; try parallux --help");
        throw Error(Fault::usage, std::string(error.what()) + "; try parallux " +
                                      (chosen.empty() ? "" : chosen[0]->get_name() + " ") +
                                      "--help");
    }
    options.command = info->parsed()      ? Command::info
                      : solve->parsed()   ? Command::solve
                      : factors->parsed() ? Command::factors
                                          : Command::compare;
    if (options.command == Command::solve)
        settle(options.solve);
    if (options.command == Command::factors)
        settle(options.factors);
    settle_sky(options.info.load.sky);
    for (double* length : {&options.info.patches.size, &options.info.solve.sphere_radius})
        *length *= options.info.load.scale;
    return options;
}

}  // namespace parallux
