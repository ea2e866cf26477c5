#include "output/charts.h"

#include <algorithm>
#include <cmath>

#include "output/atlas.h"
#include "parallux/error.h"

namespace parallux {

namespace {

constexpr std::uint32_t largest_picture = 65536;
constexpr double largest_scale = 64;

std::vector<AtlasRect> owned(const std::vector<ChartGrid>& grids) {
    std::vector<AtlasRect> rectangles;
    rectangles.reserve(grids.size());
    for (const ChartGrid& grid : grids)
        rectangles.push_back({owned_texels(grid.width()), owned_texels(grid.height())});
    return rectangles;
}

// The finest grids that fit a square of so many texels.
std::vector<ChartGrid> fitting(const Scene& scene, const Patches& patches, bool flat,
                               std::uint32_t size) {
    auto fits = [&](double scale) {
        std::vector<AtlasRect> rectangles = owned(chart_grids(scene, patches, flat, scale));
        return pack_shelves(rectangles, size) <= size;
    };
    if (!fits(0))
        throw Error(Fault::usage, scene.file.string() + ": a lightmap of " + std::to_string(size) +
                                      " texels is too small for its surfaces; choose a larger one");
    double low = 0, high = 1;
    while (high < largest_scale && fits(high))
        low = high, high *= 2;
    for (int step = 0; step < 20; ++step) {
        double middle = 0.5 * (low + high);
        (fits(middle) ? low : high) = middle;
    }
    return chart_grids(scene, patches, flat, low);
}

}  // namespace

glm::dvec2 ChartGrid::uv(std::uint32_t i, std::uint32_t j) const {
    double within = !flat ? 0 : shape == Shape::triangle ? 1.0 / 3 : 0.5;
    return {(i + within) / cells_u, (j + within) / cells_v};
}

glm::dvec2 ChartGrid::texel(const glm::dvec2& uv) const {
    double first = flat ? 0 : 0.5;
    return {uv.x * cells_u + first, uv.y * cells_v + first};
}

std::uint32_t owned_texels(std::uint32_t inner) {
    return (inner + 2 * chart_padding + 1) / 2 * 2;
}

std::vector<ChartGrid> chart_grids(const Scene& scene, const Patches& patches, bool flat,
                                   double scale) {
    std::vector<ChartGrid> grids;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        auto cells = [&](std::uint32_t n) {
            return static_cast<std::uint32_t>(std::clamp(std::round(n * scale), 1.0, 1e9));
        };
        for (std::uint32_t side : {grid.front, grid.back})
            if (side != none)
                grids.push_back({scene.surfaces[s].shape(), cells(grid.nu), cells(grid.nv), flat});
    }
    return grids;
}

std::vector<ChartGrid> lay_charts(const Scene& scene, const Patches& patches, Lightmap& lightmap) {
    const LightmapSettings& settings = lightmap.settings;
    const bool given = settings.size > 0;
    std::vector<ChartGrid> grids =
        given ? fitting(scene, patches, settings.flat, std::min(settings.size, largest_picture))
              : chart_grids(scene, patches, settings.flat, 1);
    std::vector<AtlasRect> rectangles = owned(grids);
    const std::uint32_t width = given ? settings.size : shelf_width(rectangles);
    const std::uint64_t height = pack_shelves(rectangles, width);
    if (width > largest_picture || height > largest_picture)
        throw Error(Fault::usage, scene.file.string() +
                                      ": a lightmap of a texel a patch would be " +
                                      std::to_string(width) + " x " + std::to_string(height) +
                                      "; give --lightmap-size or larger patches");
    lightmap.width = width;
    lightmap.height = given ? settings.size : static_cast<std::uint32_t>(height);
    std::size_t next = 0;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        for (bool back : {false, true})
            if ((back ? patches.grids[s].back : patches.grids[s].front) != none) {
                const AtlasRect& r = rectangles[next];
                const ChartGrid& grid = grids[next++];
                lightmap.charts.push_back({s, back, r.x + chart_padding, r.y + chart_padding,
                                           grid.width(), grid.height()});
            }
    return grids;
}

}  // namespace parallux
