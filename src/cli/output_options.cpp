#include "cli/output_options.h"

#include <tuple>

#include "cli/option_group.h"
#include "cli/options.h"
#include "cli/values.h"

namespace parallux {

namespace {

std::filesystem::path parse_image(const std::string& value) {
    std::filesystem::path file = parse_output("--image", value);
    if (file.extension() != ".exr" && file.extension() != ".png")
        refuse("--image", value, "expected a name that ends in .exr or .png");
    return file;
}

// How pictures are drawn; of no use without them, but for what bakes share.
void add_picture(CLI::App& app, CLI::Option* image, SolveOptions& o) {
    PictureSettings& picture = o.picture;
    const OptionGroup option{app, "Picture"};
    auto of_picture = [&](CLI::Option* added) { added->needs(image)->group("Picture"); };
    of_picture(app.add_option("--camera", o.camera, "By name or index [the first]")
                   ->type_name("NAME|INDEX"));
    of_picture(option(
        "--size", "WxH", "Pixels; W alone takes the camera's aspect [1024]",
        [&](auto& v) { std::tie(picture.width, picture.height) = parse_size("--size", v); }));
    option("--exposure", "EV", "Stops on top of the automatic exposure of PNG and --unlit [0]",
           [&](auto& v) {
               picture.exposure = o.bake.exposure = parse_real("--exposure", v, -64, 64);
           });
    of_picture(option("--tone", "CURVE", "Of PNG: filmic or clamp [filmic]", [&](auto& v) {
        picture.filmic = parse_choice<bool>("--tone", v, {{"filmic", true}, {"clamp", false}});
    }));
    of_picture(option("--samples", "N", "Camera rays a pixel [16]", [&](auto& v) {
        picture.samples = static_cast<std::uint32_t>(parse_count("--samples", v, 1, 65536));
    }));
    app.add_flag("--flat", picture.flat, "Show the patches unsmoothed, in bakes as well")
        ->group("Picture");
}

}  // namespace

void add_outputs(CLI::App& app, SolveOptions& o) {
    const OptionGroup option{app, "Outputs"};
    // One file an option: a list would swallow the scene's name.
    auto* image = app.add_option_function<std::vector<std::string>>(
        "--image",
        [&](const std::vector<std::string>& values) {
            for (const std::string& value : values)
                o.images.push_back(parse_image(value));
        },
        "Picture: .exr (linear, all layers) or .png (as the eye sees it); repeatable");
    image->type_name("FILE")->allow_extra_args(false)->group("Outputs");
    option("--table", "FILE.csv", "One row a patch: place, area, radiosity, irradiance …",
           [&](auto& v) { o.table = parse_output("--table", v); });
    option("--stats", "FILE.json", "Counts, seconds, energy balance, hash of the run",
           [&](auto& v) { o.stats = parse_output("--stats", v); });
    add_picture(app, image, o);
}

void add_run_outputs(CLI::App& app, SolveOptions& o) {
    OptionGroup{app, "Outputs"}(
        "--save", "FILE.plx",
        "The solution, for parallux render and bake to make outputs from without solving again",
        [&](auto& v) {
            o.save = parse_output("--save", v);
            if (o.save.extension() != ".plx")
                refuse("--save", v, "expected a name that ends in .plx");
        });
    OptionGroup{app, "Picture"}(
        "--refresh", "S",
        "Rewrite the pictures while the run goes on, with what the groups of bundles done so far "
        "come to, at most every S seconds [off]",
        [&](auto& v) { o.refresh = parse_positive("--refresh", v); })
        ->needs("--image");
}

}  // namespace parallux
