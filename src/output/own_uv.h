#pragma once

#include "output/bake_values.h"
#include "parallux/lightmap.h"

namespace parallux {

/// Throws Fault::input naming an object without lightmap_uv.
void check_own_uv(const Scene& scene);

/// Fills a lightmap's picture in the layout of the scene's own lightmap_uv, from the surfaces of
/// its object or of all. Throws Fault::input where they overlap. Linear in texels and surfaces.
void paint_own_uv(const Scene& scene, const BakeValues& values, Lightmap& lightmap);

}  // namespace parallux
