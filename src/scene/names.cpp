#include <limits>

#include "parallux/changes.h"
#include "parallux/error.h"
#include "scene/input.h"

namespace parallux {

bool name_fits(const std::string& name, const std::string& pattern) {
    std::size_t n = 0, p = 0, star = std::string::npos, from = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            from = n;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
            ++p;
            ++n;
        } else if (star != std::string::npos) {
            // The last * takes one byte more.
            p = star + 1;
            n = ++from;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string::npos;
}

std::vector<bool> named_surfaces(const Scene& scene, const std::vector<std::string>& patterns,
                                 const std::string& option) {
    std::vector<bool> named(scene.surfaces.size());
    for (const std::string& pattern : patterns) {
        std::vector<bool> objects, materials;
        for (const std::string& name : scene.objects)
            objects.push_back(name_fits(name, pattern));
        for (const Material& material : scene.materials)
            materials.push_back(name_fits(material.name, pattern));
        bool any = false;
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            if (objects[scene.surfaces[s].object] || materials[scene.surfaces[s].material])
                named[s] = any = true;
        if (!any)
            throw Error(Fault::usage, option + " " + printable(pattern) + ": no surface of " +
                                          scene.file.string() +
                                          " has such an object or material name");
    }
    return named;
}

void exclude_surfaces(Scene& scene, const std::vector<std::string>& patterns) {
    const std::vector<bool> out = named_surfaces(scene, patterns, "--exclude");
    const glm::vec2 no_uv(std::numeric_limits<float>::quiet_NaN());
    if (!scene.lightmap_uv.empty())
        scene.lightmap_uv.resize(scene.surfaces.size(), {no_uv, no_uv, no_uv});
    std::size_t left = 0;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        if (out[s])
            continue;
        scene.surfaces[left] = scene.surfaces[s];
        if (!scene.attributes.empty())
            scene.attributes[left] = scene.attributes[s];
        if (!scene.lightmap_uv.empty())
            scene.lightmap_uv[left] = scene.lightmap_uv[s];
        ++left;
    }
    if (left == 0)
        throw Error(Fault::usage, "--exclude: nothing would be left of " + scene.file.string());
    scene.surfaces.resize(left);
    if (!scene.attributes.empty())
        scene.attributes.resize(left);
    if (!scene.lightmap_uv.empty())
        scene.lightmap_uv.resize(left);
}

}  // namespace parallux
