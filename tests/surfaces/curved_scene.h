#pragma once

#include <string>

#include "parallux/scene.h"
#include "scene/scene_files.h"

namespace parallux::test {

/// A scene of the surfaces given, of one band.
inline Scene curved_scene(const std::string& surfaces, const std::string& materials = "[]") {
    TestFolder folder;
    return load_scene(folder.write("scene.json", R"({"parallux": 1, "bands": 1, "materials": )" +
                                                     materials + R"(, "surfaces": [)" + surfaces +
                                                     "]}"));
}

// Closed solids, that no line may pass through an odd number of times. Their grids differ from
// surface to surface, and so do the places where angles begin.
struct Solid {
    const char* name;
    const char* surfaces;
};
inline const Solid solids[] = {
    {"sphere", R"({"sphere": {"centre": [0.1, 0.2, 0.3], "radius": 1}, "grid": [5, 7]})"},
    {"cylinder",
     R"({"cylinder": {"base": [0, 0, 0], "axis": [0.3, 0.4, 1], "radius": 0.8}, "grid": [3, 7]},
        {"disk": {"centre": [0, 0, 0], "normal": [-0.3, -0.4, -1], "radius": 0.8}, "grid": [2, 5]},
        {"disk": {"centre": [0.3, 0.4, 1], "normal": [0.3, 0.4, 1], "radius": 0.8,
                  "start": [1, 2, 0.5]}, "grid": [3, 4]})"},
    {"cone",
     R"({"cone": {"base": [0, 0, 0], "axis": [0, 0.2, 1.3], "radius": 0.9}, "grid": [4, 5]},
        {"disk": {"centre": [0, 0, 0], "normal": [0, -0.2, -1.3], "radius": 0.9}, "grid": [1, 7]})"},
    {"frustum and half spheres",
     R"({"cone": {"base": [0, 0, 0], "axis": [0, 0, 1.3], "radius": 0.9, "top": 0.5},
         "grid": [2, 11]},
        {"sphere": {"centre": [0, 0, 0], "radius": 0.9}, "trim": [[0, 0], [0.5, 1]],
         "grid": [3, 6]},
        {"sphere": {"centre": [0, 0, 1.3], "radius": 0.5, "start": [1, 1, 0]},
         "trim": [[0.5, 0], [1, 1]], "grid": [2, 9]})"},
    {"torus",
     R"({"torus": {"centre": [0, 0, 0], "axis": [1, 1, 2], "radius": 1, "tube": 0.35},
         "grid": [6, 13]})"},
    {"vase",
     R"({"revolved": {"base": [0, 0, 0], "axis": [0.1, 0, 1],
         "profile": [[0, 0], [0.4, 0], [0.7, 0.1], [0.7, 0.5], [0.7, 0.9], [0.2, 0.8], [0.2, 1.2],
                     [0.2, 1.4], [0.1, 1.5], [0, 1.5]]}, "grid": [4, 9]})"},
    {"half a barrel on a box",
     R"({"cylinder": {"base": [0, 0, 1], "axis": [0, 3, 0], "radius": 1, "start": [-1, 0, 0],
         "angle": 180}, "grid": [3, 5]},
        {"disk": {"centre": [0, 0, 1], "normal": [0, 1, 0], "radius": 1, "start": [-1, 0, 0],
         "angle": 180}, "grid": [3, 4], "turned": true},
        {"disk": {"centre": [0, 3, 1], "normal": [0, -1, 0], "radius": 1, "start": [1, 0, 0],
         "angle": 180}, "grid": [2, 3], "turned": true},
        {"parallelogram": [[-1, 0, 0], [0, 3, 0], [2, 0, 0]], "grid": [3, 2]},
        {"parallelogram": [[-1, 0, 0], [0, 0, 1], [0, 3, 0]], "grid": [2, 2]},
        {"parallelogram": [[1, 3, 0], [0, 0, 1], [0, -3, 0]], "grid": [2, 5]},
        {"parallelogram": [[1, 0, 0], [0, 0, 1], [-2, 0, 0]], "grid": [1, 1]},
        {"parallelogram": [[-1, 3, 0], [0, 0, 1], [2, 0, 0]], "grid": [3, 3]})"},
    {"pillow",
     R"({"bicubic": [[0,0,0], [1,0,0], [2,0,0], [3,0,0], [0,1,0], [1,1,1], [2,1,1], [3,1,0],
                     [0,2,0], [1,2,1], [2,2,1], [3,2,0], [0,3,0], [1,3,0], [2,3,0], [3,3,0]],
         "grid": [5, 3]},
        {"bicubic": [[0,0,0], [0,1,0], [0,2,0], [0,3,0], [1,0,0], [1,1,-2], [1,2,-1], [1,3,0],
                     [2,0,0], [2,1,-1], [2,2,-1], [2,3,0], [3,0,0], [3,1,0], [3,2,0], [3,3,0]],
         "grid": [2, 7]})"},
    {"twisted prism",
     R"({"bilinear": [[0,0,0], [1,0,0], [1,0.4,1], [0,-0.3,1.2]], "grid": [3, 2]},
        {"bilinear": [[1,0,0], [1,1,0], [0.9,1.2,1], [1,0.4,1]], "grid": [2, 5]},
        {"bilinear": [[1,1,0], [0,1,0], [-0.2,1,1], [0.9,1.2,1]], "grid": [4, 1]},
        {"bilinear": [[0,1,0], [0,0,0], [0,-0.3,1.2], [-0.2,1,1]], "grid": [3, 3]},
        {"bilinear": [[0,0,0], [0,1,0], [1,1,0], [1,0,0]], "grid": [2, 3]},
        {"bilinear": [[0,-0.3,1.2], [1,0.4,1], [0.9,1.2,1], [-0.2,1,1]], "grid": [1, 6]})"},
};

}  // namespace parallux::test
