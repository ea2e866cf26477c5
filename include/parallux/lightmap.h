#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "parallux/bake.h"

// Stage 7d: what remains, as one picture over all surfaces.

namespace parallux {

struct LightmapSettings {
    Quantity quantity = Quantity::radiosity;
    bool flat = false;       ///< a texel a cell with its own value; else texels at cells' corners
    std::uint32_t size = 0;  ///< width and height at most; 0: as the patches' grids have it
    bool own_uv = false;     ///< charts are the scene's own lightmap_uv; size 0 is then 1024
    bool by_object = false;  ///< with own_uv: a picture for each object, whose layouts may overlap
    unsigned threads = 0;
};

/// Where one side of a surface lies in the picture: texels x … x + width - 1 hold its values, and
/// two more all round (where the picture needs them, three) hold the nearest of those.
/// A triangle fills its square's lower half (u + v ≤ 1).
struct Chart {
    std::uint32_t surface = 0;
    bool back = false;
    std::uint32_t x = 0, y = 0, width = 0, height = 0;  ///< inner texels
};

/// Texels that a chart owns beyond its inner ones, on each side. Charts with them begin at even
/// texels and have even sides, so that neither bilinear filtering nor the first mip level mixes
/// two.
inline constexpr std::uint32_t chart_padding = 2;

/// One picture of all charts, row 0 at the top, values per band together; texels of no chart are 0.
struct Lightmap {
    LightmapSettings settings;
    std::uint32_t object = none;  ///< by_object: the one whose surfaces it shows
    std::uint32_t width = 0, height = 0, bands = 0;
    std::vector<float> values;
    std::vector<Chart> charts;  ///< by surface, fronts before backs; none with own_uv
    Bake mesh;  ///< the scene's triangles; uv1 are the picture's coordinates; not by_object
};

/// Smoothed, texels lie on the corners of the surface's cells and filtering between them gives the
/// same values as pictures show where the reflectance has no texture; a shared edge has equal
/// texels on both its sides, so no seam. Where a wall stands on a corner and its cells see
/// different values the darkest is taken: no light comes through under walls. Flat, they lie on the
/// cells' centres (of a triangle's two cells to a square the one at its corner). With `size`, grids
/// are coarser or finer. With own_uv, every texel within a triangle's place in the picture or three
/// texels of it holds the value of the nearest point of a front; places outside [0, 1] are left
/// out, and so are backs. Throws Fault::input where a surface has no such coordinates, Fault::usage
/// where the charts do not fit. Equal bits for any number of threads.
Lightmap make_lightmap(const Scene& scene, const Patches& patches, const Solution& solution,
                       const LightmapSettings& settings);

/// The same by_object: calls `take` with one picture after the other, by object; only one is in
/// memory at a time. Surfaces of one object that overlap are refused as above.
void make_object_lightmaps(const Scene& scene, const Patches& patches, const Solution& solution,
                           const LightmapSettings& settings,
                           const std::function<void(const Lightmap&)>& take);

/// The mesh of a lightmap in the scene's own layout. Throws Fault::input as make_lightmap.
Bake own_uv_mesh(const Scene& scene, const Patches& patches, const LightmapSettings& settings);

/// The pictures of by_object, one an object: of room.exr and the object Large box
/// room_Large_box.exr. What file names cannot hold everywhere becomes _, and equal names, also but
/// for case, get _2, _3 …
std::vector<std::filesystem::path> object_lightmaps(const std::filesystem::path& file,
                                                    const Scene& scene);

/// The file of the mesh that belongs to a lightmap: room.exr has room.glb.
std::filesystem::path lightmap_mesh(const std::filesystem::path& file);

/// Writes the picture as EXR (float, linear; quantity, unit, scene and object in its header) and
/// beside it the mesh as GLB: TEXCOORD_1 into the lightmap, TEXCOORD_0 and, where pictures need it,
/// TEXCOORD_2 as the scene has them, its materials, its pictures as PNG and its vertex colours.
/// Each file is whole or untouched; throws Fault::output.
void write_lightmap(const std::filesystem::path& file, const Scene& scene,
                    const Lightmap& lightmap);

/// The two apart. The mesh's extras name `pictures`: one for all, or one an object.
void write_lightmap_picture(const std::filesystem::path& file, const Scene& scene,
                            const Lightmap& lightmap);
void write_lightmap_mesh(const std::filesystem::path& file, const Scene& scene, const Bake& mesh,
                         const std::vector<std::filesystem::path>& pictures);

}  // namespace parallux
