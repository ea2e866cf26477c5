#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallux/solve.h"

// Stage 7c: what remains, on the scene's own geometry: vertex colours and lightmaps.

namespace parallux {

/// What a bake holds, linear Rec. 709 where the scene has three bands.
///  irradiance  H, W/m²: light that arrives
///  radiosity   B = E + ρ H, W/m²: light that leaves
///  radiance    B / π, W/(m² sr): what a camera sees
enum class Quantity : std::uint8_t { irradiance, radiosity, radiance };

/// original: the scene's triangles; patches: one quad or triangle a cell of every patch.
enum class BakeMesh : std::uint8_t { original, patches };

struct BakeSettings {
    Quantity quantity = Quantity::radiosity;
    BakeMesh mesh = BakeMesh::original;
    bool flat = false;    ///< each cell's own value, unsmoothed
    bool unlit = false;   ///< ready to view: exposed, clamped to [0, 1], KHR_materials_unlit
    double exposure = 0;  ///< unlit: stops on top of the automatic exposure
    /// Leave the pictures of materials that have one and emit nothing out of radiosity and
    /// radiance: glTF then carries the picture, which colours multiply. Of PLY false.
    bool textures = false;
    unsigned threads = 0;
};

/// One drawable piece: triangles of one object, one material and one kind of side.
struct BakePart {
    std::uint32_t object = none;  ///< index into Scene::objects; none: unnamed
    std::uint32_t material = 0;   ///< index into Scene::materials
    bool both_sides = false;      ///< front and back show the same values on one face
    std::uint32_t first_vertex = 0;
    std::uint32_t vertices = 0;
    std::vector<std::uint32_t> indices;  ///< three a triangle, counted from first_vertex
};

/// Triangles with a value a vertex. Corners share a vertex only where place, values and texture
/// coordinates are equal and the surface has no crease: colours do not run over edges.
/// A two-sided surface is two faces, the back one turned round, unless both sides have equal
/// values.
struct Bake {
    BakeSettings settings;
    double factor = 1;  ///< colours = factor × quantity; other than 1 only where unlit
    std::vector<glm::vec3> positions, normals, colours;
    /// Empty, or one a vertex: the scene's first, the lightmap's, the scene's second.
    std::vector<glm::vec2> uv0, uv1, uv2;
    std::vector<BakePart> parts;  ///< by object, material and sides
};

/// Values at the mesh's vertices: irradiance as pictures interpolate it, reflectance and emission
/// at the very point. Scenes of other than three bands give grey, their bands' mean. Equal bits for
/// any number of threads. n log n in patches.
Bake make_bake(const Scene& scene, const Patches& patches, const Solution& solution,
               const BakeSettings& settings);

/// Writes .glb or .gltf (COLOR_0 as float, times a power of two where any is above 1; buffers and
/// pictures inside the one file) or .ply (binary little
/// endian, float red green blue). Quantity, unit, colour space and exposure stand in glTF's extras
/// and PLY's comments. The file is whole or untouched; throws Fault::output.
void write_bake(const std::filesystem::path& file, const Scene& scene, const Bake& bake);

/// "irradiance", "radiosity", "radiance"; "W/m2" or "W/(m2 sr)".
const char* quantity_name(Quantity quantity);
const char* quantity_unit(Quantity quantity);

}  // namespace parallux
