#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "factors/judge.h"
#include "output/output_file.h"
#include "parallux/error.h"

// View factors and net short wave of an urban scene: bundles against local rays and the solver, on
// one thread, each against a long run of bundles with another seed.

using namespace parallux;
using namespace parallux::factor_bench;

namespace {

// Up to so many, the reference's sky is from points.
constexpr std::size_t few_facets = 2000;

struct Options {
    std::string scene, json;
    std::vector<std::uint64_t> bundles{64, 256, 1024, 4096}, solve{64, 256, 1024, 4096};
    std::vector<double> lines_per_patch{0};
    std::vector<std::uint64_t> lines;
    std::vector<std::uint32_t> rays{16, 64, 256, 1024};
    std::uint64_t reference = 8192;
    std::size_t facets = 0;
    bool tiny = false;
};

// A court of walls on a floor, for a try-out without files.
Scene court() {
    Scene scene;
    scene.bands = 1;
    scene.materials.emplace_back();
    scene.materials[0].reflectance = Spectrum::constant(0.5f);
    scene.objects = {"court"};
    constexpr std::uint32_t n = 6;
    auto add = [&](glm::dvec3 origin, glm::dvec3 u, glm::dvec3 v) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (std::uint32_t y = 0; y <= n; ++y)
            for (std::uint32_t x = 0; x <= n; ++x)
                scene.positions.push_back(origin + u * (double(x) / n) + v * (double(y) / n));
        for (std::uint32_t y = 0; y < n; ++y)
            for (std::uint32_t x = 0; x < n; ++x) {
                const std::uint32_t a = first + y * (n + 1) + x, b = a + n + 1;
                Surface surface;
                surface.corner = {a, a + 1, b + 1, none};
                scene.surfaces.push_back(surface);
                surface.corner = {a, b + 1, b, none};
                scene.surfaces.push_back(surface);
            }
    };
    add({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
    add({0, 0, 0}, {0, 3, 0}, {0, 0, 2});
    add({4, 0, 0}, {0, 0, 2}, {0, 3, 0});
    add({0, 3, 0}, {4, 0, 0}, {0, 0, 2});
    return scene;
}

// Leaves the facets nearest to the middle of the scene's bounds, seen from above.
void keep_nearest(std::size_t facets, Scene& scene) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& position : scene.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const glm::dvec2 middle(0.5 * (low + high));
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const glm::dvec2 away =
            glm::dvec2(surface_point(scene, scene.surfaces[s], 1 / 3.0, 1 / 3.0)) - middle;
        order.emplace_back(glm::dot(away, away), s);
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), facets));
    std::vector<Surface> kept;
    for (const auto& [distance, s] : order)
        kept.push_back(scene.surfaces[s]);
    scene.surfaces = std::move(kept);
    // Positions that nothing is left of would widen the sphere of lines.
    std::vector<glm::dvec3> positions;
    for (Surface& surface : scene.surfaces)
        for (std::uint32_t& corner : surface.corner)
            if (corner != none) {
                positions.push_back(scene.positions[corner]);
                corner = static_cast<std::uint32_t>(positions.size() - 1);
            }
    scene.positions = std::move(positions);
}

int run(const Options& options) {
    if (!options.json.empty())
        check_writable(options.json);
    if (!options.tiny && !std::filesystem::exists(options.scene)) {
        std::printf("%s is not here; nothing to measure\n", options.scene.c_str());
        return 0;
    }
    LoadSettings load;
    load.keep_triangles = true;
    Scene scene = options.tiny ? court() : load_scene(options.scene, load);
    if (options.facets > 0)
        keep_nearest(options.facets, scene);
    PatchSettings facets;
    facets.size = 1e15;
    facets.clusters = false;
    const Patches patches = make_patches(scene, facets);
    const std::string name =
        options.tiny ? "court" : std::filesystem::path(options.scene).parent_path().filename();
    Answer reference = by_bundles(scene, patches, options.reference, 1000, 0, SkyFrom::lines);
    if (scene.surfaces.size() <= few_facets)
        with_fine_sky(scene, patches, reference);
    std::vector<Row> rows;
    auto take = [&](const std::string& method, std::uint64_t effort, const Answer& answer) {
        rows.push_back(judge(name, method, effort, patches, answer, reference));
        print_row(rows.back());
    };
    print_heading();
    for (double lines : options.lines_per_patch)
        for (std::uint64_t bundles : options.bundles)
            take(lines > 0 ? "bundles-" + std::to_string(std::lround(lines)) : "bundles", bundles,
                 by_bundles(scene, patches, bundles, 1, 1, SkyFrom::automatic, lines));
    for (std::uint64_t bundles : options.lines)
        take("lines", bundles, by_bundles(scene, patches, bundles, 1, 1, SkyFrom::lines));
    for (std::uint32_t rays : options.rays)
        take("rays", rays, by_rays(scene, patches, rays, 1));
    for (std::uint64_t bundles : options.solve)
        take("solve", bundles, by_solve(scene, patches, bundles, 1));
    if (!options.json.empty())
        write_rows(options.json, rows);
    // All three must come to one answer.
    bool good = true;
    for (const Row& row : rows)
        good &= !options.tiny || row.net_l2 < 0.02;
    return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"View factors: bundles, local rays, and the solver"};
    Options options;
    options.scene = std::string(PARALLUX_SHARED_SCENES) + "/urban-udales-949/geom.949.STL";
    app.add_option("--scene", options.scene, "A scene of triangles");
    app.add_option("--json", options.json, "Where to write the rows");
    app.add_option("--bundles", options.bundles, "Lengths of bundles")->delimiter(',');
    app.add_option("--lines-per-patch", options.lines_per_patch, "Of bundles; 0: chosen")
        ->delimiter(',');
    app.add_option("--lines", options.lines, "The same with all sky factors from lines")
        ->delimiter(',');
    app.add_option("--rays", options.rays, "Rays a facet")->delimiter(',');
    app.add_option("--solve", options.solve, "Lengths of the solver")->delimiter(',');
    app.add_option("--reference", options.reference, "Bundles of the reference");
    app.add_option("--facets", options.facets, "Only so many in the scene's middle; 0: all");
    app.add_flag("--tiny", options.tiny, "A court; exit code 1 when the methods do not agree");
    CLI11_PARSE(app, argc, argv);
    if (options.tiny) {
        options.bundles = options.solve = {2048};
        options.rays = {1024};
        options.reference = 8192;
    }
    try {
        return run(options);
    } catch (const Error& error) {
        std::fprintf(stderr, "factors: %s\n", error.what());
        return static_cast<int>(error.fault());
    }
}
