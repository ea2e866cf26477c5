#include "cli/option_group.h"
#include "cli/options.h"
#include "cli/output_options.h"
#include "cli/values.h"

namespace parallux {

namespace {

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

// What bakes hold.
void add_bake_shape(CLI::App& app, CLI::Option* bake, SolveOptions& o) {
    const OptionGroup option{app, "Bake"};
    option("--bake-mesh", "M", "original, or patches: a face a patch [original]", [&](auto& v) {
        o.bake.mesh = parse_choice<BakeMesh>(
            "--bake-mesh", v, {{"original", BakeMesh::original}, {"patches", BakeMesh::patches}});
    })->needs(bake);
    option("--quantity", "Q", "irradiance, radiosity or radiance [radiosity]", [&](auto& v) {
        o.bake.quantity = o.lightmap_settings.quantity =
            parse_choice<Quantity>("--quantity", v,
                                   {{"irradiance", Quantity::irradiance},
                                    {"radiosity", Quantity::radiosity},
                                    {"radiance", Quantity::radiance}});
    });
    option("--bake-textures", "T",
           "keep (glTF carries the scene's pictures, colours multiply them), or bake: colours "
           "hold them, at vertices [keep]",
           [&](auto& v) {
               o.bake.textures =
                   parse_choice<bool>("--bake-textures", v, {{"keep", true}, {"bake", false}});
           })
        ->needs(bake);
    app.add_flag("--unlit", o.bake.unlit,
                 "Ready to view: exposed, clamped to 1, KHR_materials_unlit")
        ->needs(bake)
        ->group(option.name);
}

// Where lightmaps have their texels.
void add_lightmap_shape(CLI::App& app, CLI::Option* lightmap, SolveOptions& o) {
    const OptionGroup option{app, "Bake"};
    option("--lightmap-uv", "UV",
           "pack (a chart a surface), own: the TEXCOORD_1 of a glTF scene, in one picture, or "
           "objects: the same with a picture for each object, FILE_OBJECT.exr [pack]",
           [&](auto& v) {
               const int kind =
                   parse_choice<int>("--lightmap-uv", v, {{"pack", 0}, {"own", 1}, {"objects", 2}});
               o.lightmap_settings.own_uv = o.load.lightmap_uv = kind > 0;
               o.lightmap_settings.by_object = kind == 2;
           });
    option("--lightmap-size", "N", "Texels wide and high [a texel a patch; with own 1024]",
           [&](auto& v) {
               o.lightmap_settings.size =
                   static_cast<std::uint32_t>(parse_count("--lightmap-size", v, 8, 65536));
           })
        ->needs(lightmap);
}

}  // namespace

void add_bakes(CLI::App& app, SolveOptions& o) {
    const OptionGroup option{app, "Outputs"};
    auto* bake = app.add_option_function<std::vector<std::string>>(
        "--bake",
        [&](const std::vector<std::string>& values) {
            for (const std::string& value : values)
                o.bakes.push_back(parse_bake(value));
        },
        "Vertex colours: .glb, .gltf (COLOR_0) or .ply; repeatable");
    bake->type_name("FILE")->allow_extra_args(false)->group("Outputs");
    auto* lightmap = option("--lightmap", "FILE.exr",
                            "A texel a patch, and beside it FILE.glb with TEXCOORD_1 into it",
                            [&](auto& v) { o.lightmap = parse_lightmap(v); });
    add_bake_shape(app, bake, o);
    add_lightmap_shape(app, lightmap, o);
}

}  // namespace parallux
