#include "parallux/lightmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "output/bake_mesh.h"
#include "output/charts.h"
#include "output/own_uv.h"
#include "output/tone.h"
#include "parallel.h"

namespace parallux {

namespace {

// Into each of the up to six cells that meet at a corner, in cells.
constexpr std::array<glm::dvec2, 6> into_cells = {
    glm::dvec2(0.01, 0.01),   glm::dvec2(-0.01, -0.01), glm::dvec2(0.01, -0.005),
    glm::dvec2(0.005, -0.01), glm::dvec2(-0.01, 0.005), glm::dvec2(-0.005, 0.01)};

// Fills the texels of one chart after the other.
class ChartPainter {
public:
    ChartPainter(const Scene& scene, const Patches& patches, const BakeValues& values,
                 Lightmap& lightmap)
        : scene_(scene), patches_(patches), values_(values), map_(lightmap) {}

    void paint(const Chart& chart, const ChartGrid& grid) const {
        const bool triangle = grid.shape == Shape::triangle;
        for (std::uint32_t j = 0; j < chart.height; ++j)
            for (std::uint32_t i = 0; i < chart.width; ++i)
                if (!triangle || i + j <= grid.last_diagonal())
                    look(chart, grid.uv(i, j), texel(chart, i, j));
        if (triangle && !grid.flat)
            mirror(chart, grid);
        dilate(chart, grid);
    }

private:
    float* texel(const Chart& chart, std::uint32_t i, std::uint32_t j) const {
        const std::size_t at = std::size_t(chart.y + j) * map_.width + (chart.x + i);
        return &map_.values[at * map_.bands];
    }

    // The darkest of what the cells around the place see there.
    void look(const Chart& chart, const glm::dvec2& uv, float* values) const {
        if (map_.settings.flat)
            return values_.at(chart.surface, chart.back, uv.x, uv.y, values);
        const SurfaceGrid& grid = patches_.grids[chart.surface];
        const Shape shape = scene_.surfaces[chart.surface].shape();
        std::array<float, max_bands> seen{};
        double darkest = HUGE_VAL;
        std::uint32_t last = none;
        for (const glm::dvec2& step : into_cells) {
            const std::uint32_t cell =
                cell_at(shape, grid.nu, grid.nv, static_cast<float>(uv.x + step.x / grid.nu),
                        static_cast<float>(uv.y + step.y / grid.nv));
            if (cell == last)
                continue;
            last = cell;
            values_.in_cell(chart.surface, chart.back, cell, uv.x, uv.y, seen.data());
            if (double l = luminance(seen.data(), map_.bands); l < darkest) {
                darkest = l;
                std::copy_n(seen.begin(), map_.bands, values);
            }
        }
    }

    // Beyond a triangle's long side, so that filtering within its last cells is linear.
    void mirror(const Chart& chart, const ChartGrid& grid) const {
        const std::uint32_t sum = grid.last_diagonal() + 1;
        for (std::uint32_t i = 1; i < sum; ++i)
            for (std::uint32_t b = 0, j = sum - i; b < map_.bands; ++b)
                texel(chart, i, j)[b] =
                    std::max(texel(chart, i - 1, j)[b] + texel(chart, i, j - 1)[b] -
                                 texel(chart, i - 1, j - 1)[b],
                             0.0f);
    }

    // Gives all other texels that the chart owns the value of the nearest one that has one.
    void dilate(const Chart& chart, const ChartGrid& grid) const {
        const bool triangle = grid.shape == Shape::triangle;
        const int limit = int(grid.last_diagonal()) + (grid.flat ? 0 : 1);
        const int width = int(chart.width), height = int(chart.height), pad = int(chart_padding);
        for (int j = -pad; j < int(owned_texels(chart.height)) - pad; ++j)
            for (int i = -pad; i < int(owned_texels(chart.width)) - pad; ++i) {
                int x = std::clamp(i, 0, width - 1), y = std::clamp(j, 0, height - 1);
                if (int over = x + y - limit; triangle && over > 0)
                    x -= over / 2, y -= over - over / 2;
                if (x != i || y != j)
                    std::copy_n(texel(chart, x, y), map_.bands, texel(chart, i, j));
            }
    }

    const Scene& scene_;
    const Patches& patches_;
    const BakeValues& values_;
    Lightmap& map_;
};

// The scene's triangles with coordinates into the picture.
void make_mesh(const Scene& scene, const Patches& patches, const std::vector<ChartGrid>& grids,
               Lightmap& lightmap) {
    lightmap.mesh.settings.quantity = lightmap.settings.quantity;
    BakeBuilder builder(lightmap.mesh);
    for (std::size_t c = 0; c < grids.size(); ++c) {
        const Chart& chart = lightmap.charts[c];
        FaceFrame frame = scene_frame(scene, patches, chart.surface, chart.back);
        for (std::uint32_t k = 0; k < frame.face.count; ++k)
            frame.face.corner[k].uv1 =
                glm::vec2((glm::dvec2(chart.x, chart.y) + grids[c].texel(frame.uv[k])) /
                          glm::dvec2(lightmap.width, lightmap.height));
        builder.add(frame.face);
    }
    builder.finish();
    drop_unused(scene, lightmap.mesh);
}

BakeSettings as_bake(const LightmapSettings& settings) {
    BakeSettings result;
    result.quantity = settings.quantity, result.flat = settings.flat;
    result.threads = settings.threads;
    return result;
}

}  // namespace

Lightmap make_lightmap(const Scene& scene, const Patches& patches, const Solution& solution,
                       const LightmapSettings& settings) {
    refuse_curves(scene, "lightmaps are of planar ones; use --bake");
    Lightmap lightmap;
    lightmap.settings = settings;
    lightmap.bands = solution.bands;
    if (settings.own_uv) {
        check_own_uv(scene);
        paint_own_uv(scene, BakeValues(scene, patches, solution, as_bake(settings)), lightmap);
        lightmap.mesh = own_uv_mesh(scene, patches, settings);
        return lightmap;
    }
    const std::vector<ChartGrid> grids = lay_charts(scene, patches, lightmap);
    lightmap.values.assign(std::size_t(lightmap.width) * lightmap.height * lightmap.bands, 0);
    BakeValues values(scene, patches, solution, as_bake(settings));
    ChartPainter painter(scene, patches, values, lightmap);
    parallel_for(settings.threads, grids.size(), 8, [&](std::size_t b, std::size_t e, unsigned) {
        for (std::size_t chart = b; chart < e; ++chart)
            painter.paint(lightmap.charts[chart], grids[chart]);
    });
    make_mesh(scene, patches, grids, lightmap);
    return lightmap;
}

void make_object_lightmaps(const Scene& scene, const Patches& patches, const Solution& solution,
                           const LightmapSettings& settings,
                           const std::function<void(const Lightmap&)>& take) {
    check_own_uv(scene);
    BakeValues values(scene, patches, solution, as_bake(settings));
    std::vector<bool> used(scene.objects.size());
    for (const Surface& surface : scene.surfaces)
        used[surface.object] = true;
    for (std::uint32_t object = 0; object < used.size(); ++object) {
        if (!used[object])
            continue;
        Lightmap map;
        map.settings = settings;
        map.object = object;
        paint_own_uv(scene, values, map);
        take(map);
    }
}

}  // namespace parallux
