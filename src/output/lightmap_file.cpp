#include <cctype>
#include <cstring>
#include <exception>
#include <set>

#include "output/bake_writers.h"
#include "output/encode.h"
#include "output/output_file.h"
#include "parallux/error.h"
#include "parallux/lightmap.h"
#include "scene/input.h"

namespace parallux {

namespace {

Image image_of(const Scene& scene, const Lightmap& lightmap) {
    Image image;
    const std::uint32_t bands = lightmap.bands;
    image.spec =
        OIIO::ImageSpec(static_cast<int>(lightmap.width), static_cast<int>(lightmap.height),
                        static_cast<int>(bands), OIIO::TypeDesc::FLOAT);
    image.spec.channelnames.clear();
    for (std::uint32_t b = 0; b < bands; ++b)
        image.spec.channelnames.push_back(band_channel(bands, b));
    image.spec.attribute("compression", "zip");
    image.spec.attribute("oiio:ColorSpace", "Linear");
    image.spec.attribute("quantity", quantity_name(lightmap.settings.quantity));
    image.spec.attribute("unit", quantity_unit(lightmap.settings.quantity));
    image.spec.attribute("scene", scene.file.filename().string());
    if (lightmap.object != none)
        image.spec.attribute("object", scene.objects[lightmap.object]);
    image.linear = lightmap.values;
    return image;
}

// A name that is a file's everywhere.
std::string fit_for_files(const std::string& name) {
    std::string fit = printable(name);
    for (char& c : fit)
        if (!std::isalnum(static_cast<unsigned char>(c)) && !std::strchr("-_.", c) &&
            static_cast<unsigned char>(c) < 0x80)
            c = '_';
    return fit.empty() ? "object" : fit;
}

std::string lower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

std::vector<std::filesystem::path> object_lightmaps(const std::filesystem::path& file,
                                                    const Scene& scene) {
    std::vector<std::filesystem::path> files;
    std::set<std::string> taken;
    for (const std::string& object : scene.objects) {
        const std::string fit = fit_for_files(object);
        std::string name = fit;
        for (int k = 2; !taken.insert(lower(name)).second; ++k)
            name = fit + "_" + std::to_string(k);
        files.push_back(std::filesystem::path(file).replace_filename(
            file.stem().string() + "_" + name + file.extension().string()));
    }
    return files;
}

void write_lightmap_picture(const std::filesystem::path& file, const Scene& scene,
                            const Lightmap& lightmap) {
    OutputFile output(file);
    std::vector<unsigned char> bytes;
    try {
        Image image = image_of(scene, lightmap);
        bytes = encode(".exr", image);
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, file.string() + ": no memory to encode the lightmap");
    } catch (const std::exception& failure) {
        throw Error(Fault::output, file.string() + ": cannot write: " + failure.what());
    }
    output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    output.commit();
}

std::filesystem::path lightmap_mesh(const std::filesystem::path& file) {
    return file.empty() ? file : std::filesystem::path(file).replace_extension(".glb");
}

void write_lightmap_mesh(const std::filesystem::path& file, const Scene& scene, const Bake& mesh,
                         const std::vector<std::filesystem::path>& pictures) {
    OutputFile output(file);
    write_gltf(output, file, scene, mesh, true, [&](std::uint32_t object) {
        if (pictures.size() == 1)
            return pictures[0].filename().string();
        return object < pictures.size() ? pictures[object].filename().string() : "";
    });
    output.commit();
}

void write_lightmap(const std::filesystem::path& file, const Scene& scene,
                    const Lightmap& lightmap) {
    write_lightmap_picture(file, scene, lightmap);
    write_lightmap_mesh(lightmap_mesh(file), scene, lightmap.mesh, {file});
}

}  // namespace parallux
