#include <exception>

#include "output/bake_writers.h"
#include "output/encode.h"
#include "output/output_file.h"
#include "parallux/error.h"
#include "parallux/lightmap.h"

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
    image.linear = lightmap.values;
    return image;
}

void write_exr(const std::filesystem::path& file, const Scene& scene, const Lightmap& lightmap) {
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

}  // namespace

std::filesystem::path lightmap_mesh(const std::filesystem::path& file) {
    return file.empty() ? file : std::filesystem::path(file).replace_extension(".glb");
}

void write_lightmap(const std::filesystem::path& file, const Scene& scene,
                    const Lightmap& lightmap) {
    write_exr(file, scene, lightmap);
    const std::filesystem::path mesh = lightmap_mesh(file);
    OutputFile output(mesh);
    write_gltf(output, mesh, scene, lightmap.mesh, true, file.filename().string());
    output.commit();
}

}  // namespace parallux
