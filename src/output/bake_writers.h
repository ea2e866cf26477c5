#pragma once

#include <functional>
#include <string>

#include "output/output_file.h"
#include "parallux/bake.h"

// The formats of a bake. Each writes all bytes, but does not commit.

namespace parallux {

/// Binary little endian PLY: x y z nx ny nz red green blue as float, then the triangles.
void write_ply(OutputFile& output, const Scene& scene, const Bake& bake);

/// The name of the picture beside a glTF that holds an object's lightmap; of none: that of all
/// objects, or "" where each has its own.
using LightmapNames = std::function<std::string(std::uint32_t object)>;

/// glTF 2.0 with its one buffer, pictures included, inside: GLB, or JSON with a data URI. With a
/// `lightmap` the materials are the scene's own, and COLOR_0 the scene's vertex colours if any;
/// without, COLOR_0 holds the bake, scaled by a power of two where it is above 1 (stated as
/// `exposure`). Throws Fault::output above the 4 GiB that GLB can hold.
void write_gltf(OutputFile& output, const std::filesystem::path& file, const Scene& scene,
                const Bake& bake, bool glb, const LightmapNames& lightmap);

}  // namespace parallux
