#include <algorithm>
#include <charconv>
#include <cmath>

#include "csv.h"
#include "parallux/changes.h"
#include "parallux/thermal.h"
#include "scene/input.h"
#include "scene/loaders.h"

namespace parallux {

namespace {

constexpr double hottest = 1e5;
constexpr const char* kinds[] = {"all", "material", "object", "surface", "patch"};

}  // namespace

Temperatures::Temperatures(const std::filesystem::path& file) : file_(file) {
    const Csv csv(file);
    const std::size_t kind = csv.need("kind"), name = csv.need("name"),
                      temperature = csv.need("temperature");
    if (csv.columns().size() != 3)
        csv.fail("has other columns than kind, name and temperature");
    for (std::size_t r = 0; r < csv.rows(); ++r) {
        const auto found = std::find(std::begin(kinds), std::end(kinds), csv.text(r, kind));
        if (found == std::end(kinds))
            csv.fail(r, "kind must be all, material, object, surface or patch, not \"" +
                            printable(csv.text(r, kind)) + "\"");
        Row row{csv.line(r), static_cast<Kind>(found - kinds), csv.text(r, name), none,
                csv.number(r, temperature, 0, hottest)};
        if (row.kind == Kind::surface || row.kind == Kind::patch) {
            const char *begin = row.name.data(), *end = begin + row.name.size();
            const auto [stop, error] = std::from_chars(begin, end, row.number);
            if (error != std::errc() || stop != end)
                csv.fail(r, std::string(*found) + "s go by their number, not by \"" +
                                printable(row.name) + "\"");
        }
        rows_.push_back(std::move(row));
    }
}

void Temperatures::fail(const Row& row, const std::string& what) const {
    input_error(file_, "line " + std::to_string(row.line), what);
}

// Keeps the first band's values alone, and returns ρ + τ.
float Temperatures::first_band_only(Material& material) const {
    if (material.specular_share() > 0)
        input_error(file_, "",
                    "material \"" + printable(material.name) +
                        "\" mirrors or is glass, whose emissivity differs by direction; "
                        "temperatures need one");
    for (Spectrum* values : {&material.reflectance, &material.transmittance,
                             &material.back_reflectance, &material.back_transmittance}) {
        const float first = (*values)[0];
        *values = {};
        (*values)[0] = first;
    }
    const float albedo = material.reflectance[0] + material.transmittance[0];
    // Both sides have one emission.
    if (material.own_back &&
        std::abs(material.back_reflectance[0] + material.back_transmittance[0] - albedo) > 1e-6f)
        input_error(file_, "",
                    "material \"" + printable(material.name) +
                        "\" has sides of unlike emissivity, 1 - ρ - τ; temperatures need one");
    return albedo;
}

// From the least specific rows to the most specific; those of patches are left for later.
std::vector<double> Temperatures::of_surfaces(const Scene& scene) const {
    std::vector<double> kelvin(scene.surfaces.size(), -1);
    for (Kind kind : {Kind::all, Kind::material, Kind::object, Kind::surface})
        for (const Row& row : rows_) {
            if (row.kind != kind)
                continue;
            bool any = false;
            for (std::size_t s = 0; s < kelvin.size(); ++s) {
                const Surface& surface = scene.surfaces[s];
                const bool fits =
                    kind == Kind::all ||
                    (kind == Kind::material &&
                     name_fits(scene.materials[surface.material].name, row.name)) ||
                    (kind == Kind::object && name_fits(scene.objects[surface.object], row.name)) ||
                    (kind == Kind::surface && s == row.number);
                if (fits) {
                    kelvin[s] = row.kelvin;
                    any = true;
                }
            }
            if (!any)
                fail(row, "no surface of the scene has " + std::string(kinds[int(kind)]) + " \"" +
                              printable(row.name) + "\"");
        }
    return kelvin;
}

void Temperatures::apply(Scene& scene, double sky) const {
    const std::vector<double> kelvin = of_surfaces(scene);
    const auto missing = std::find(kelvin.begin(), kelvin.end(), -1.0);
    if (missing != kelvin.end()) {
        const auto s = static_cast<std::size_t>(missing - kelvin.begin());
        input_error(file_, "",
                    "no temperature for surface " + std::to_string(s) + " of object \"" +
                        printable(scene.objects[scene.surfaces[s].object]) +
                        "\"; a row \"all,,T\" gives one to the rest");
    }

    // One material for every temperature that a material's surfaces have.
    std::vector<Material> materials;
    std::vector<std::vector<std::pair<double, std::uint32_t>>> made(scene.materials.size());
    Tally textured;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const std::uint32_t old = scene.surfaces[s].material;
        auto& known = made[old];
        auto same = std::find_if(known.begin(), known.end(),
                                 [&](const auto& one) { return one.first == kelvin[s]; });
        if (same == known.end()) {
            Material material = scene.materials[old];
            if (material.reflectance_texture != none && known.empty())
                textured.note(material.name);
            const float albedo = first_band_only(material);
            material.emission = {};
            material.emission[0] = static_cast<float>((1 - double(albedo)) * black_body(kelvin[s]));
            material.reflectance_texture = material.emission_texture = none;
            known.push_back({kelvin[s], static_cast<std::uint32_t>(materials.size())});
            materials.push_back(std::move(material));
            same = known.end() - 1;
        }
        scene.surfaces[s].material = same->second;
    }
    textured.warn(
        scene, "materials",
        "have one emissivity, 1 - their factor of the first band, in place of a picture's");
    scene.materials = std::move(materials);
    scene.attributes.clear();
    scene.bands = 1;
    scene.lights.clear();
    const glm::dvec3 up = scene.sky.up;
    scene.sky = {};
    scene.sky.up = up;
    if (sky > 0) {
        scene.sky.kind = Sky::Kind::uniform;
        scene.sky.zenith[0] = static_cast<float>(black_body(sky) / pi);
        scene.sky.horizon = scene.sky.ground = scene.sky.zenith;
    }
}

void Temperatures::apply(Patches& patches) const {
    for (const Row& row : rows_) {
        if (row.kind != Kind::patch)
            continue;
        if (row.number >= patches.count())
            fail(row, "no patch " + std::to_string(row.number) + "; there are " +
                          std::to_string(patches.count()));
        patches.emission[row.number] =
            static_cast<float>((1 - double(patches.albedo(row.number))) * black_body(row.kelvin));
    }
}

}  // namespace parallux
