#pragma once

#include <string>

#include "output/output_file.h"
#include "parallux/bake.h"

// The formats of a bake. Each writes all bytes, but does not commit.

namespace parallux {

/// Binary little endian PLY: x y z nx ny nz red green blue as float, then the triangles.
void write_ply(OutputFile& output, const Scene& scene, const Bake& bake);

/// glTF 2.0 with its one buffer inside: GLB, or JSON with a data URI. With a `lightmap` (the name
/// of a picture beside the file) the vertices carry texture coordinates, and materials their own
/// colours, in place of COLOR_0. Throws Fault::output above the 4 GiB that GLB can hold.
void write_gltf(OutputFile& output, const std::filesystem::path& file, const Scene& scene,
                const Bake& bake, bool glb, const std::string& lightmap);

}  // namespace parallux
