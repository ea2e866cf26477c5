#include "scene/bands.h"

#include <algorithm>

#include "scene/input.h"

namespace parallux {

namespace {

// Spreads single values, and says of which thing they are not single.
class Spreading {
public:
    Spreading(const Scene& scene, std::uint32_t bands) : scene_(scene), bands_(bands) {}

    void operator()(Spectrum& values, bool single, const std::string& what) const {
        for (std::uint32_t band = 1; band < scene_.bands; ++band)
            single = single && values[band] == values[0];
        if (!single)
            input_error(scene_.file, what,
                        "has values for " + std::to_string(scene_.bands) + " bands and none for " +
                            std::to_string(bands_) + "; give them in a table for --materials");
        std::fill_n(values.value.begin(), bands_, float(values[0]));
        std::fill(values.value.begin() + bands_, values.value.end(), 0.0f);
    }

private:
    const Scene& scene_;
    std::uint32_t bands_;
};

// The materials that a surface has, and those that vertex colours vary.
struct InUse {
    std::vector<bool> any, coloured;
};

InUse in_use(const Scene& scene) {
    InUse use{std::vector<bool>(scene.materials.size()), std::vector<bool>(scene.materials.size())};
    const SurfaceAttributes white;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const std::uint32_t material = scene.surfaces[s].material;
        use.any[material] = true;
        if (!scene.attributes.empty() && scene.attributes[s].colour != white.colour)
            use.coloured[material] = true;
    }
    return use;
}

}  // namespace

void spread_bands(Scene& scene, std::uint32_t bands, const ValuesKept& kept) {
    if (bands == scene.bands)
        return;
    const Spreading spread(scene, bands);
    const InUse use = in_use(scene);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        if (!use.any[m])
            continue;
        const std::string what = "material \"" + printable(material.name) + "\"";
        if (kept.reflectance[m])
            spread(material.reflectance, material.reflectance_texture == none && !use.coloured[m],
                   what);
        if (kept.transmittance[m])
            spread(material.transmittance, true, what);
        if (material.own_back && kept.back_reflectance[m])
            spread(material.back_reflectance,
                   material.reflectance_texture == none && !use.coloured[m], what);
        if (material.own_back && kept.back_transmittance[m])
            spread(material.back_transmittance, true, what);
        if (material.specular.kind != Specular::Kind::absent) {
            spread(material.specular.colour,
                   material.reflectance_texture == none && !use.coloured[m], what);
            spread(material.specular.grazing, true, what);
            spread(material.specular.absorption, true, what);
        }
        if (kept.emission[m])
            spread(material.emission, material.emission_texture == none, what);
    }
    for (Light& light : scene.lights)
        spread(light.intensity, true, "light \"" + printable(light.name) + "\"");
    if (scene.sky.kind != Sky::Kind::dark)
        for (Spectrum* part : {&scene.sky.zenith, &scene.sky.horizon, &scene.sky.ground})
            spread(*part, scene.sky.kind != Sky::Kind::image, "its sky");
    scene.bands = bands;
}

}  // namespace parallux
