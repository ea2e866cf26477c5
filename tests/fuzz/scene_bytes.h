#pragma once

#include <filesystem>

#include "fuzz.h"
#include "parallux/patches.h"
#include "parallux/scene.h"
#include "scene/loaders.h"

// Bytes read as a scene: what every reader promises of what it lets through.

namespace parallux::fuzz {

inline bool finite(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

inline void check_specular(const Specular& specular, std::uint32_t bands) {
    require(specular.share >= 0 && specular.share <= 1, "0 <= share <= 1");
    require(specular.roughness >= 0 && specular.roughness <= 1, "0 <= roughness <= 1");
    require(specular.ior >= 1 && specular.ior <= 4, "1 <= refractive index <= 4");
    for (std::size_t b = 0; b < bands; ++b) {
        const float colour = specular.colour[b], grazing = specular.grazing[b];
        require(colour >= 0 && colour <= 1, "0 <= colour <= 1");
        require(grazing >= 0 && grazing <= 1, "0 <= grazing <= 1");
        require(specular.absorption[b] >= 0 && std::isfinite(specular.absorption[b]),
                "absorption >= 0 and finite");
    }
}

inline void check_materials(const Scene& scene) {
    for (const Material& material : scene.materials) {
        for (std::size_t b = 0; b < scene.bands; ++b) {
            const float reflectance = material.reflectance[b], emission = material.emission[b];
            require(reflectance >= 0 && reflectance < 1, "0 <= reflectance < 1");
            require(emission >= 0 && std::isfinite(emission), "emission >= 0 and finite");
        }
        check_specular(material.specular, scene.bands);
        for (std::uint32_t texture : {material.reflectance_texture, material.emission_texture})
            require(texture == none || texture < scene.textures.size(), "a texture that is there");
        require(material.reflectance_uv < 2 && material.emission_uv < 2, "coordinates 0 or 1");
    }
    for (const Texture& texture : scene.textures)
        require(texture.texels.size() == std::size_t(texture.width) * texture.height &&
                    !texture.texels.empty(),
                "as many texels as the size says");
}

inline void check_scene(const Scene& scene) {
    require(scene.bands >= 1 && scene.bands <= max_bands, "1 to 8 bands");
    require(!scene.surfaces.empty(), "a scene has surfaces");
    require(scene.attributes.empty() || scene.attributes.size() == scene.surfaces.size(),
            "attributes of each surface or of none");
    for (const glm::dvec3& p : scene.positions)
        require(
            finite(p) && std::abs(p.x) <= 1e15 && std::abs(p.y) <= 1e15 && std::abs(p.z) <= 1e15,
            "positions up to 1e15");
    for (const Surface& surface : scene.surfaces) {
        for (std::size_t k = 0; k < 4; ++k)
            require(
                surface.corner[k] < scene.positions.size() || (k == 3 && surface.corner[k] == none),
                "corners that are there");
        require(surface.material < scene.materials.size(), "a material that is there");
        require(surface.object < scene.objects.size(), "an object that is there");
        require(surface_area(scene, surface) > 0, "surfaces have area");
        require(finite(surface_normal(scene, surface)), "surfaces have a normal");
    }
    for (const std::string& name : scene.objects)
        require(printable(name, name.size() + 1) == name, "names are clean text");
    for (const std::string& line : scene.warnings)
        require(printable(line, line.size() + 1) == line, "warnings are clean lines");
    for (const Camera& camera : scene.cameras)
        require(finite(camera.position) && finite(camera.forward) && finite(camera.up),
                "cameras stand somewhere");
    for (const Light& light : scene.lights)
        require(finite(light.position) && finite(light.direction), "lights stand somewhere");
}

inline void check_patches(const Scene& scene) {
    ends_well({Fault::input, Fault::memory}, [&] {
        const Patches patches = make_patches(scene, {.count = 64});
        for (std::size_t patch = 0; patch < patches.count(); ++patch)
            require(patches.area[patch] >= 0 && std::isfinite(patches.area[patch]),
                    "areas are finite");
        for (float reflectance : patches.reflectance)
            require(reflectance >= 0 && reflectance < 1, "0 <= reflectance < 1 of patches");
        for (float emission : patches.emission)
            require(emission >= 0 && std::isfinite(emission), "emission of patches >= 0");
    });
}

/// Loads a file of this name in the folder of the companions, that has these bytes.
inline int read_scene_bytes(const char* name, std::string bytes) {
    const std::filesystem::path file = std::filesystem::path(PARALLUX_FUZZ_FILES) / name;
    ends_well({Fault::input, Fault::memory}, [&] {
        const Scene scene = scene_of(file, std::move(bytes), {});
        check_scene(scene);
        std::uint64_t cells = 0;
        for (const Surface& surface : scene.surfaces)
            cells += std::uint64_t(surface.grid_u) * surface.grid_v;
        if (cells < 20000 && scene.surfaces.size() < 20000)
            check_patches(scene);
    });
    return 0;
}

}  // namespace parallux::fuzz
