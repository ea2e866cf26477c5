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

// A quantity of the table: where a material has it, and how large it may be.
struct Quantity {
    const char* name;
    Spectrum Material::*values;
    double most;
    std::vector<bool> ValuesKept::*kept;
    Columns columns = {};

    bool given() const { return !columns.of_band.empty(); }
};

const double below_one = std::nextafter(1.0f, 0.0f);

std::vector<Quantity> quantities_of(const Csv& csv) {
    std::vector<Quantity> all = {
        {"reflectance", &Material::reflectance, below_one, &ValuesKept::reflectance},
        {"transmittance", &Material::transmittance, below_one, &ValuesKept::transmittance},
        {"back_reflectance", &Material::back_reflectance, below_one, &ValuesKept::back_reflectance},
        {"back_transmittance", &Material::back_transmittance, below_one,
         &ValuesKept::back_transmittance},
        {"emission", &Material::emission, 1e15, &ValuesKept::emission}};
    for (Quantity& one : all)
        one.columns = columns_of(csv, one.name);
    return all;
}

// The number of bands that all quantities have.
std::uint32_t check_columns(const Csv& csv, const std::vector<Quantity>& quantities) {
    for (const std::string& name : csv.columns()) {
        const bool known = std::any_of(
            quantities.begin(), quantities.end(),
            [&](const Quantity& one) { return name.rfind(one.name + std::string("_"), 0) == 0; });
        if (name != "material" && !known)
            csv.fail("column " + printable(name) +
                     " is none of material, reflectance_0 …, transmittance_0 …, the same of back_, "
                     "and emission_0 …");
    }
    const Quantity* first = nullptr;
    for (const Quantity& one : quantities) {
        if (!one.given())
            continue;
        if (first && first->columns.of_band.size() != one.columns.of_band.size())
            csv.fail("has " + std::to_string(first->columns.of_band.size()) + " bands of " +
                     first->name + " but " + std::to_string(one.columns.of_band.size()) + " of " +
                     one.name);
        first = first ? first : &one;
    }
    if (!first)
        csv.fail("has neither reflectance nor emission columns");
    return static_cast<std::uint32_t>(first->columns.of_band.size());
}

Spectrum values(const Csv& csv, std::size_t row, const Columns& columns, double high) {
    Spectrum result;
    for (std::size_t band = 0; band < columns.of_band.size(); ++band)
        result[band] = static_cast<float>(csv.number(row, columns.of_band[band], 0, high));
    return result;
}

// The back is as the front, unless the table or, of what the table does not have, the scene says
// otherwise.
void settle_back(const Material& before, ValuesKept& kept, Material& material) {
    const bool given = !kept.back_reflectance.back() || !kept.back_transmittance.back();
    const bool front = !kept.reflectance.back() || !kept.transmittance.back();
    if (!given && (front || !before.own_back)) {
        material.own_back = false;
        material.back_reflectance = material.back_transmittance = {};
        return;
    }
    material.own_back = true;
    const auto [reflectance, transmittance] =
        before.own_back && !front ? std::pair(before.back_reflectance, before.back_transmittance)
                                  : std::pair(material.reflectance, material.transmittance);
    if (kept.back_reflectance.back()) {
        material.back_reflectance = reflectance;
        kept.back_reflectance.back() = kept.reflectance.back();
    }
    if (kept.back_transmittance.back()) {
        material.back_transmittance = transmittance;
        kept.back_transmittance.back() = kept.transmittance.back();
    }
}

}  // namespace

void set_materials(Scene& scene, const std::filesystem::path& file, std::uint32_t bands) {
    const Csv csv(file);
    const std::size_t name_column = csv.need("material");
    const std::vector<Quantity> quantities = quantities_of(csv);
    const std::uint32_t in_file = check_columns(csv, quantities);
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
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        const Material before = material;
        const bool listed = row_of[m] != Csv::absent;
        for (const Quantity& one : quantities) {
            (kept.*one.kept).push_back(!listed || !one.given());
            if (!(kept.*one.kept).back())
                material.*one.values = values(csv, row_of[m], one.columns, one.most);
        }
        if (!kept.reflectance.back() && std::exchange(material.reflectance_texture, none) != none)
            textured.note(material.name);
        if (!kept.emission.back() && std::exchange(material.emission_texture, none) != none)
            textured.note(material.name);
        if (listed)
            settle_back(before, kept, material);
        if (const std::string fault = side_fault(material); listed && !fault.empty())
            csv.fail(row_of[m], "material \"" + printable(material.name) + "\": " + fault);
    }
    for (std::size_t s = 0; s < scene.attributes.size(); ++s)
        if (!kept.reflectance[scene.surfaces[s].material])
            scene.attributes[s].colour = SurfaceAttributes{}.colour;
    textured.warn(scene, "textured materials", "have the values of " + file.string() + " instead");
    spread_bands(scene, in_file, kept);
}

void set_bands(Scene& scene, std::uint32_t bands) {
    const std::vector<bool> all(scene.materials.size(), true);
    spread_bands(scene, bands, {all, all, all, all, all});
}

}  // namespace parallux
