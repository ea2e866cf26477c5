// What a sphere costs to project, beside its bounding box: processor seconds of the pairs of the
// same bundles, one thread, the least of some rounds. Facets are what other curved surfaces cost.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <utility>

#include "lines/facets.h"
#include "parallux/lines.h"
#include "parallux/patches.h"

using namespace parallux;

namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Scene empty_scene() {
    Scene scene;
    scene.bands = 1;
    scene.materials.emplace_back();
    scene.materials[0].reflectance = Spectrum::constant(0.5f);
    scene.objects = {"solid"};
    return scene;
}

Scene sphere() {
    Scene scene = empty_scene();
    Curve curve;
    curve.profile = Curve::Profile::arc;
    curve.point[1] = {1, 0, 0};
    curve.point[2] = {0, 1, 0};
    curve.radius = 1;
    curve.start = -pi / 2;
    curve.end = pi / 2;
    std::swap(curve.low.y, curve.high.y);
    scene.curves = {curve};
    scene.positions = {{0, 0, -1}};
    Surface surface;
    surface.curve = 0;
    surface.grid_u = surface.grid_v = 12;
    scene.surfaces = {surface};
    return scene;
}

Scene box() {
    Scene scene = empty_scene();
    for (int k = 0; k < 8; ++k)
        scene.positions.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    for (const auto& face : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                             {4, 5, 7, 6},
                             {0, 1, 5, 4},
                             {2, 6, 7, 3},
                             {0, 4, 6, 2},
                             {1, 3, 7, 5}}) {
        Surface surface;
        surface.corner = face;
        surface.grid_u = surface.grid_v = 5;
        scene.surfaces.push_back(surface);
    }
    return scene;
}

double seconds(const Projector& projector, const BundleSettings& settings) {
    auto workspace = projector.make_workspace();
    Projection projection;
    TilePairs pairs;
    const double begin = processor_seconds();
    for (std::uint64_t k = 0; k < settings.count; ++k) {
        projector.project(make_bundle(settings, k), projection);
        for (std::size_t tile = 0; tile < projection.tiles(); ++tile)
            projector.pairs(projection, tile, *workspace, pairs);
    }
    return processor_seconds() - begin;
}

}  // namespace

int main(int count, char** arguments) {
    const bool tiny = count > 1 && std::strcmp(arguments[1], "--tiny") == 0;
    const Scene round = sphere(), flat = box();
    const Patches round_patches = make_patches(round), flat_patches = make_patches(flat);
    std::printf("%10s %12s %12s %12s %14s %14s\n", "spacing", "box, s", "sphere, s", "facets, s",
                "sphere / box", "facets / box");
    for (double spacing : {0.05, 0.02, 0.01, 0.005, 0.002}) {
        if (tiny && spacing < 0.02)
            break;
        BundleSettings settings;
        settings.spacing = spacing;
        settings.count =
            static_cast<std::uint64_t>(std::max(4.0, (tiny ? 0.1 : 20) * spacing * 1e3));
        const Facets cut =
            make_facets(round, round_patches, facet_chord(round, spacing), Spheres::facets);
        const Projector of_box(flat, flat_patches), whole(round, round_patches),
            facets(cut.scene, cut.patches);
        double least[3] = {1e30, 1e30, 1e30};
        for (int lap = 0; lap < (tiny ? 1 : 5); ++lap) {
            const Projector* each[3] = {&of_box, &whole, &facets};
            for (int way = 0; way < 3; ++way)
                least[way] = std::min(least[way], seconds(*each[way], settings));
        }
        std::printf("%10g %12.5f %12.5f %12.5f %14.2f %14.2f\n", spacing, least[0], least[1],
                    least[2], least[1] / least[0], least[2] / least[0]);
    }
}
