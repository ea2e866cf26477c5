#include "scene/obj.h"
#include "scene_bytes.h"

using namespace parallux;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::filesystem::path file = std::filesystem::path(PARALLUX_FUZZ_FILES) / "meshes/a.mtl";
    fuzz::ends_well({Fault::input, Fault::memory}, [&] {
        Scene scene;
        scene.file = file;
        SceneBuilder builder(scene, {});
        TextureReader textures(scene);
        std::map<std::string, std::uint32_t> materials;
        read_mtl(builder, textures, file, {reinterpret_cast<const char*>(data), size}, materials);
        fuzz::check_materials(scene);
        for (const auto& [name, index] : materials)
            fuzz::require(index < scene.materials.size(), "names of materials that are there");
    });
    return 0;
}
