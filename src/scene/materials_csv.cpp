#include <algorithm>
#include <cmath>
#include <utility>

#include "csv.h"
#include "parallux/changes.h"
#include "parallux/error.h"
#include "scene/bands.h"
#include "scene/input.h"
#include "scene/loaders.h"

namespace parallux {

namespace {

// The columns of a quantity, band by band; none: the table does not have it.
struct Columns {
    std::vector<std::size_t> of_band;
};

// A band by its name, "3" or one of r, g, b; absent: no band.
std::size_t band_of(const std::string& name) {
    const std::size_t colour = std::string("rgb").find(name);
    if (name.size() == 1 && colour != std::string::npos)
        return colour;
    const bool digit = name.size() == 1 && name[0] >= '0' && name[0] < char('0' + max_bands);
    return digit ? static_cast<std::size_t>(name[0] - '0') : Csv::absent;
}

Columns columns_of(const Csv& csv, const std::string& quantity) {
    Columns columns;
    bool colours = false;
    for (std::size_t c = 0; c < csv.columns().size(); ++c) {
        const std::string& name = csv.columns()[c];
        if (name.rfind(quantity + "_", 0) != 0)
            continue;
        const std::string band_name = name.substr(quantity.size() + 1);
        const std::size_t band = band_of(band_name);
        if (band == Csv::absent)
            csv.fail("column " + printable(name) + " names no band; they are 0 to 7, or r, g, b");
        colours = colours || band_name[0] > '9';
        if (columns.of_band.size() <= band)
            columns.of_band.resize(band + 1, Csv::absent);
        if (columns.of_band[band] != Csv::absent)
            csv.fail("column " + printable(name) + " names a band that another one names");
        columns.of_band[band] = c;
    }
    const auto gap = std::find(columns.of_band.begin(), columns.of_band.end(), Csv::absent);
    if (gap != columns.of_band.end() || (colours && columns.of_band.size() != 3))
        csv.fail("the columns of " + quantity + " leave out a band before the last one");
    return columns;
}

void check_columns(const Csv& csv, const Columns& reflectance, const Columns& emission) {
    for (const std::string& name : csv.columns())
        if (name != "material" && name.rfind("reflectance_", 0) != 0 &&
            name.rfind("emission_", 0) != 0)
            csv.fail("column " + printable(name) +
                     (name.rfind("transmittance", 0) == 0
                          ? " asks for what is not done: surfaces reflect or absorb"
                          : " is none of material, reflectance_0 … and emission_0 …"));
    if (reflectance.of_band.empty() && emission.of_band.empty())
        csv.fail("has neither reflectance nor emission columns");
    if (!reflectance.of_band.empty() && !emission.of_band.empty() &&
        reflectance.of_band.size() != emission.of_band.size())
        csv.fail("has " + std::to_string(reflectance.of_band.size()) +
                 " bands of reflectance but " + std::to_string(emission.of_band.size()) +
                 " of emission");
}

Spectrum values(const Csv& csv, std::size_t row, const Columns& columns, double high) {
    Spectrum result;
    for (std::size_t band = 0; band < columns.of_band.size(); ++band)
        result[band] = static_cast<float>(csv.number(row, columns.of_band[band], 0, high));
    return result;
}

}  // namespace

void set_materials(Scene& scene, const std::filesystem::path& file, std::uint32_t bands) {
    const Csv csv(file);
    const std::size_t name_column = csv.need("material");
    const Columns reflectance = columns_of(csv, "reflectance");
    const Columns emission = columns_of(csv, "emission");
    check_columns(csv, reflectance, emission);
    const auto in_file =
        static_cast<std::uint32_t>(std::max(reflectance.of_band.size(), emission.of_band.size()));
    if (bands != 0 && bands != in_file)
        throw Error(Fault::usage, "--bands " + std::to_string(bands) + ": " + file.string() +
                                      " has values for " + std::to_string(in_file));

    // Find each row's materials; several of a scene may have one name.
    std::vector<std::size_t> row_of(scene.materials.size(), Csv::absent);
    for (std::size_t row = 0; row < csv.rows(); ++row) {
        bool known = false;
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            if (scene.materials[m].name == csv.text(row, name_column)) {
                if (row_of[m] != Csv::absent)
                    csv.fail(row, "a second row for material \"" +
                                      printable(csv.text(row, name_column)) + "\"");
                row_of[m] = row;
                known = true;
            }
        if (!known)
            csv.fail(row, "the scene has no material \"" + printable(csv.text(row, name_column)) +
                              "\"; see parallux info");
    }

    // What the table says is the whole value: nothing of the scene's multiplies it any more.
    ValuesKept kept;
    Tally textured;
    const double below_one = std::nextafter(1.0f, 0.0f);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        const bool listed = row_of[m] != Csv::absent;
        kept.reflectance.push_back(!listed || reflectance.of_band.empty());
        kept.emission.push_back(!listed || emission.of_band.empty());
        if (!kept.reflectance.back()) {
            material.reflectance = values(csv, row_of[m], reflectance, below_one);
            if (std::exchange(material.reflectance_texture, none) != none)
                textured.note(material.name);
        }
        if (!kept.emission.back()) {
            material.emission = values(csv, row_of[m], emission, 1e15);
            if (std::exchange(material.emission_texture, none) != none)
                textured.note(material.name);
        }
    }
    for (std::size_t s = 0; s < scene.attributes.size(); ++s)
        if (!kept.reflectance[scene.surfaces[s].material])
            scene.attributes[s].colour = SurfaceAttributes{}.colour;
    textured.warn(scene, "textured materials", "have the values of " + file.string() + " instead");
    spread_bands(scene, in_file, kept);
}

void set_bands(Scene& scene, std::uint32_t bands) {
    const std::vector<bool> all(scene.materials.size(), true);
    spread_bands(scene, bands, {all, all});
}

}  // namespace parallux
