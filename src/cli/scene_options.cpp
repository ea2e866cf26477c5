#include "cli/scene_options.h"

#include "cli/option_group.h"
#include "cli/sky_options.h"
#include "cli/values.h"

namespace parallux {

void add_scene(CLI::App& app, std::filesystem::path& scene, LoadSettings& load) {
    const OptionGroup option{app, "Scene"};
    app.add_option("SCENE", scene, "glTF (.gltf, .glb), OBJ, STL or Parallux (.json) scene")
        ->required()
        ->type_name("");
    option("--scale", "X", "Metres per unit of the scene file [1]",
           [&](auto& v) { load.scale = parse_positive("--scale", v); });
    option("--reflectance", "R", "Of faces without a material, as in STL, 0 to 0.999 [0.5]",
           [&](auto& v) {
               load.reflectance =
                   Spectrum::constant(static_cast<float>(parse_real("--reflectance", v, 0, 0.999)));
           });
    option(
        "--sky", "SKY",
        "In place of the scene's: dark, uniform:L, overcast:L, clear:L (radiance, at the zenith, "
        "W/(m² sr)), perez:D (diffuse horizontal W/m²), image:FILE; with :ALBEDO, as in "
        "perez:120:0.2, ground that it and the sun light",
        [&](auto& v) { parse_sky("--sky", v, load.sky); });
    option("--periodic", "X,Y",
           "The scene repeats without end after so many of its units along x and y (z where y is "
           "up); 0: not that way",
           [&](auto& v) { load.period = parse_period("--periodic", v); });
    option("--sun", "H,AZ[,D]",
           "In place of the scene's: elevation, azimuth from north by east (degrees), direct W/m² "
           "[0]",
           [&](auto& v) { parse_sun("--sun", v, load.sky); });
}

}  // namespace parallux
