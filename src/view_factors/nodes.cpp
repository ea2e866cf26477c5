#include "view_factors/nodes.h"

#include <glm/geometric.hpp>

namespace parallux {

namespace {

std::size_t group_of(const Scene& scene, const PatchPlace& place, std::size_t patch,
                     FactorNodes between) {
    switch (between) {
        case FactorNodes::patches:
            return patch;
        case FactorNodes::surfaces:
            return 2 * std::size_t(place.surface) + place.back;
        case FactorNodes::objects:
            return scene.surfaces[place.surface].object;
        case FactorNodes::materials:
            return scene.surfaces[place.surface].material;
    }
    return patch;
}

std::size_t groups_of(const Scene& scene, const Patches& patches, FactorNodes between) {
    switch (between) {
        case FactorNodes::patches:
            return patches.count();
        case FactorNodes::surfaces:
            return 2 * scene.surfaces.size();
        case FactorNodes::objects:
            return scene.objects.size();
        case FactorNodes::materials:
            return scene.materials.size();
    }
    return 0;
}

void add_patch(const Scene& scene, const PatchPlace& place, double area, FactorNodes between,
               FactorNode& node) {
    const Surface& surface = scene.surfaces[place.surface];
    const std::string& material = scene.materials[surface.material].name;
    if (node.area == 0) {
        node.name = between == FactorNodes::materials ? material : scene.objects[surface.object];
        node.material = material;
    } else if (node.material != material) {
        node.material.clear();
    }
    node.area += area;
    node.centre += area * place.centre;
    node.normal += area * place.normal;
}

}  // namespace

NodeMap make_nodes(const Scene& scene, const Patches& patches, FactorNodes between) {
    const std::vector<PatchPlace> places = patch_places(scene, patches);
    NodeMap map;
    map.of_patch.resize(patches.count());
    std::vector<std::uint32_t> node_of(groups_of(scene, patches, between), none);
    for (std::size_t patch = 0; patch < places.size(); ++patch)
        node_of[group_of(scene, places[patch], patch, between)] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& node : node_of)
        node = node == none ? none : count++;
    map.nodes.resize(count);
    for (std::size_t patch = 0; patch < places.size(); ++patch) {
        const std::uint32_t node = node_of[group_of(scene, places[patch], patch, between)];
        map.of_patch[patch] = node;
        add_patch(scene, places[patch], patches.area[patch], between, map.nodes[node]);
    }
    for (FactorNode& node : map.nodes) {
        node.centre /= node.area;
        const double length = glm::length(node.normal);
        node.normal = length > 1e-9 * node.area ? node.normal / length : glm::dvec3(0);
    }
    return map;
}

}  // namespace parallux
