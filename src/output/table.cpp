#include <algorithm>

#include "output/output_file.h"
#include "output/row.h"
#include "output/table_columns.h"
#include "parallux/error.h"
#include "parallux/patches.h"
#include "parallux/tables.h"

namespace parallux {

std::string band_name(std::uint32_t bands, std::uint32_t band) {
    return bands == 3 ? std::string(1, "rgb"[band]) : std::to_string(band);
}

namespace {

// Text of this size goes to the file at once: few system calls, little memory.
constexpr std::size_t chunk = std::size_t{1} << 20;

// So many places are less than what the solver has given back.
constexpr std::size_t places_at_once = std::size_t{1} << 19;

}  // namespace

void write_table(const std::filesystem::path& file, const Scene& scene, const Patches& patches,
                 const Solution& solution, const std::vector<bool>& receivers) {
    const std::size_t bands = solution.bands, values = patches.count() * bands;
    const bool estimated = !solution.stderror.empty();
    if (patches.bands != bands || solution.radiosity.size() != values ||
        solution.irradiance.size() != values || (estimated && solution.stderror.size() != values))
        throw Error(Fault::internal, file.string() + ": the solution is not of these patches");

    OutputFile output(file);
    std::string text;
    Row row(text);
    std::vector<PatchPlace> places;
    for (const std::string& name : table_columns(solution.bands, patches.translucent()))
        row.word(name);
    row.end();
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        if (patch % places_at_once == 0)
            places = patch_places(scene, patches, patch,
                                  std::min(patch + places_at_once, patches.count()));
        const PatchPlace& place = places[patch % places_at_once];
        if (!receivers.empty() && !receivers[place.surface])
            continue;
        const Surface& surface = scene.surfaces.at(place.surface);
        row.index(patch).index(place.surface);
        row.word(scene.objects.at(surface.object));
        row.word(scene.materials.at(surface.material).name);
        row.index(place.iu).index(place.iv);
        for (const glm::dvec3& v : {place.centre, place.normal})
            row.number(v.x).number(v.y).number(v.z);
        row.number(patches.area[patch]).word(place.back ? "back" : "front");
        for (std::size_t i = patch * bands; i < (patch + 1) * bands; ++i) {
            row.number(patches.reflectance[i]).number(patches.emission[i]);
            row.number(solution.irradiance[i]).number(solution.radiosity[i]);
            estimated ? row.number(solution.stderror[i]) : row.word("");
        }
        for (std::size_t i = patch * bands; patches.translucent() && i < (patch + 1) * bands; ++i)
            row.number(patches.transmittance[i]);
        row.end();
        if (text.size() >= chunk) {
            output.write(text);
            text.clear();
        }
    }
    output.write(text);
    output.commit();
}

}  // namespace parallux
