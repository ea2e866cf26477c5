#include "output/own_uv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "output/bake_mesh.h"
#include "output/pieces.h"
#include "parallel.h"
#include "parallux/error.h"

namespace parallux {

namespace {

constexpr double reach = 3;  // texels around a triangle that take its nearest value

// The point of a surface that a texel shows.
struct Seen {
    float distance = HUGE_VALF;  // squared, in texels
    std::uint32_t surface = none;
    float u = 0, v = 0;
    bool shared = false;  // lies well within two surfaces
};

// A triangle in the picture, in texels, and its corners' (u, v).
struct Placed {
    std::array<glm::dvec2, 3> at, uv;
};

glm::dvec2 own_place(const Scene& scene, std::uint32_t s, const glm::dvec2& uv) {
    const auto& own = scene.lightmap_uv[s];
    return glm::dvec2(own[0]) + uv.x * glm::dvec2(own[1] - own[0]) +
           uv.y * glm::dvec2(own[2] - own[0]);
}

// Weights of the corners at the triangle's point nearest to p.
std::array<double, 3> nearest(const std::array<glm::dvec2, 3>& t, const glm::dvec2& p) {
    auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(t[1] - t[0], t[2] - t[0]);
    if (area != 0) {
        const double b = cross(p - t[0], t[2] - t[0]) / area;
        const double c = cross(t[1] - t[0], p - t[0]) / area;
        if (b >= 0 && c >= 0 && b + c <= 1)
            return {1 - b - c, b, c};
    }
    std::array<double, 3> best{};
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const glm::dvec2 side = t[next] - t[k];
        const double length = glm::dot(side, side);
        const double along =
            length > 0 ? std::clamp(glm::dot(p - t[k], side) / length, 0.0, 1.0) : 0;
        if (double d = glm::distance(p, t[k] + along * side); d < least) {
            least = d;
            best = {};
            best[k] = 1 - along, best[next] = along;
        }
    }
    return best;
}

void cover(const Placed& triangle, std::uint32_t surface, const Lightmap& map,
           std::vector<Seen>& seen) {
    glm::dvec2 low = glm::min(triangle.at[0], glm::min(triangle.at[1], triangle.at[2])) - reach;
    glm::dvec2 high = glm::max(triangle.at[0], glm::max(triangle.at[1], triangle.at[2])) + reach;
    low = glm::max(glm::floor(low), glm::dvec2(0));
    high = glm::min(glm::ceil(high), glm::dvec2(map.width, map.height));
    for (double y = low.y; y < high.y; ++y)
        for (double x = low.x; x < high.x; ++x) {
            const glm::dvec2 centre(x + 0.5, y + 0.5);
            const std::array<double, 3> w = nearest(triangle.at, centre);
            const glm::dvec2 way =
                w[0] * triangle.at[0] + w[1] * triangle.at[1] + w[2] * triangle.at[2] - centre;
            const double inside = std::min({w[0], w[1], w[2]});
            const auto distance = inside > 0 ? 0.0f : static_cast<float>(glm::dot(way, way));
            Seen& texel =
                seen[static_cast<std::size_t>(y) * map.width + static_cast<std::size_t>(x)];
            texel.shared =
                texel.shared || (inside > 1e-3 && texel.distance < 0 && texel.surface != surface);
            if (distance > reach * reach || distance >= texel.distance)
                continue;
            const glm::dvec2 uv =
                w[0] * triangle.uv[0] + w[1] * triangle.uv[1] + w[2] * triangle.uv[2];
            // Well within is less than 0: what else comes there is an overlap.
            texel = {inside > 1e-3 ? -1.0f : distance, surface, static_cast<float>(uv.x),
                     static_cast<float>(uv.y), texel.shared};
        }
}

void cover_surface(const Scene& scene, std::uint32_t s, const Lightmap& map,
                   std::vector<Seen>& seen) {
    const glm::dvec2 size(map.width, map.height);
    const Shape shape = scene.surfaces[s].shape();
    const CellCorners whole = cell_corners(shape, SurfaceGrid{}, 0);
    constexpr std::uint32_t corners[2][3] = {{0, 1, 3}, {3, 1, 2}};
    for (std::uint32_t t = 0; t + 2 < whole.count; ++t) {
        Placed triangle;
        for (std::uint32_t k = 0; k < 3; ++k) {
            triangle.uv[k] = whole.uv[whole.count == 3 ? k : corners[t][k]];
            triangle.at[k] = own_place(scene, s, triangle.uv[k]) * size;
        }
        cover(triangle, s, map, seen);
    }
}

// Layouts made for one picture an object overlap when all share one.
void check_overlap(const Scene& scene, const Lightmap& map, const std::vector<Seen>& seen) {
    std::size_t covered = 0, shared = 0;
    std::uint32_t example = 0;
    for (const Seen& texel : seen) {
        covered += texel.surface != none && texel.distance <= 0;
        if (texel.shared && shared++ == 0)
            example = scene.surfaces[texel.surface].object;
    }
    if (shared > 8 + covered / 1000)
        throw Error(Fault::input,
                    scene.file.string() + ": surfaces lie upon each other in TEXCOORD_1 (" +
                        std::to_string(shared) + " of " + std::to_string(covered) +
                        " texels, one of object '" +
                        (example < scene.objects.size() ? scene.objects[example] : "") +
                        "'); use --lightmap-uv " +
                        (map.object == none ? "objects or pack" : "pack"));
}

}  // namespace

void check_own_uv(const Scene& scene) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (s >= scene.lightmap_uv.size() || std::isnan(scene.lightmap_uv[s][0].x)) {
            const std::uint32_t object = scene.surfaces[s].object;
            throw Error(Fault::input,
                        scene.file.string() + ": object '" +
                            (object < scene.objects.size() ? scene.objects[object] : "") +
                            "' has no TEXCOORD_1 for a lightmap; use --lightmap-uv pack");
        }
}

void paint_own_uv(const Scene& scene, const BakeValues& values, Lightmap& map) {
    map.width = map.height = map.settings.size > 0 ? map.settings.size : 1024;
    map.bands = values.bands();
    // Find what each texel shows, triangle after triangle.
    std::vector<Seen> seen(std::size_t(map.width) * map.height);
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (map.object == none || map.object == scene.surfaces[s].object)
            cover_surface(scene, s, map, seen);
    check_overlap(scene, map, seen);
    // Look there.
    map.values.assign(seen.size() * map.bands, 0);
    parallel_for(map.settings.threads, seen.size(), 1024,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t i = begin; i < end; ++i)
                         if (seen[i].surface != none)
                             values.at(seen[i].surface, false, seen[i].u, seen[i].v,
                                       &map.values[i * map.bands]);
                 });
}

Bake own_uv_mesh(const Scene& scene, const Patches& patches, const LightmapSettings& settings) {
    check_own_uv(scene);
    Bake mesh;
    mesh.settings.quantity = settings.quantity;
    BakeBuilder builder(mesh);
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        FaceFrame frame = scene_frame(scene, patches, s, false);
        frame.face.both_sides = patches.grids[s].back != none;
        for (std::uint32_t k = 0; k < frame.face.count; ++k)
            frame.face.corner[k].uv1 = glm::vec2(own_place(scene, s, frame.uv[k]));
        builder.add(frame.face);
    }
    builder.finish();
    drop_unused(scene, mesh);
    return mesh;
}

}  // namespace parallux
