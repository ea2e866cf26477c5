#pragma once

#include "parallux/lightmap.h"

namespace parallux {

/// Fills a lightmap in the layout of the scene's own lightmap_uv: picture and mesh. Throws
/// Fault::input naming an object that has none. Linear in texels and surfaces.
void paint_own_uv(const Scene& scene, const Patches& patches, const Solution& solution,
                  Lightmap& lightmap);

}  // namespace parallux
