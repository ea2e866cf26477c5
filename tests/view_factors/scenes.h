#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

#include "factors/form_factors.h"
#include "parallux/factors.h"
#include "support/hand_made.h"

namespace parallux::test {

/// A one-sided parallelogram, one cell, an object of its own.
inline void add_plate(Scene& scene, glm::dvec3 origin, glm::dvec3 u, glm::dvec3 v,
                      const std::string& name) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.bands = 1;
    if (scene.materials.empty())
        scene.materials.push_back(grey(0.5));
    Surface surface;
    surface.object = static_cast<std::uint32_t>(scene.objects.size());
    surface.corner = {first, first + 1, first + 2, first + 3};
    surface.grid_u = surface.grid_v = 1;
    scene.objects.push_back(name);
    for (const glm::dvec3& corner : {origin, origin + u, origin + u + v, origin + v})
        scene.positions.push_back(corner);
    scene.surfaces.push_back(surface);
}

inline Polygon polygon_of(const Scene& scene, std::uint32_t surface) {
    Polygon polygon;
    for (std::uint32_t corner : scene.surfaces[surface].corner)
        if (corner != none)
            polygon.add(scene.positions[corner]);
    return polygon;
}

/// A ball within a ball, facing each other.
inline Scene concentric_balls(double inner, double outer, std::uint32_t rings) {
    Scene scene;
    scene.bands = 1;
    add_ball(scene, glm::dvec3(0), inner, rings, grey(0.5));
    const std::size_t inside = scene.surfaces.size();
    add_ball(scene, glm::dvec3(0), outer, rings, grey(0.5));
    for (std::size_t s = inside; s < scene.surfaces.size(); ++s)
        std::swap(scene.surfaces[s].corner[1], scene.surfaces[s].corner[2]);
    return scene;
}

inline Patches one_each(const Scene& scene) {
    PatchSettings settings;
    settings.size = 1e15;
    settings.clusters = false;
    return make_patches(scene, settings);
}

/// F_ij; 0 where none is stored.
inline double factor(const Factors& factors, std::size_t i, std::size_t j) {
    for (std::uint64_t k = factors.start[i]; k < factors.start[i + 1]; ++k)
        if (factors.column[k] == j)
            return factors.exchange[k] / factors.nodes[i].area;
    return 0;
}

inline double outside(const Factors& factors, std::size_t i, std::uint32_t k) {
    return factors.outside[i * factors.outsides() + k];
}

/// A file's name in a folder of temporary files, gone at the end.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("parallux-factors-" + std::to_string(getpid()) + "-" + name)) {}
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::string text() const {
        std::ifstream in(path_, std::ios::binary);
        std::ostringstream all;
        all << in.rdbuf();
        return all.str();
    }

private:
    std::filesystem::path path_;
};

}  // namespace parallux::test
