#include <chrono>
#include <vector>

#include "scene_files.h"

using namespace parallux;

namespace {

const std::filesystem::path shared = PARALLUX_SHARED_SCENES;

struct Known {
    const char* file;
    std::uint64_t triangles, zero_area;
};

}  // namespace

// Fails when instances are counted once, when a strip or a primitive is left out, or when faces
// without area (at a float's resolution) are kept or honest ones dropped.
TEST_CASE("real scenes have the triangles that are known of them") {
    if (!std::filesystem::exists(shared)) {
        MESSAGE("no scenes at " << shared.string() << "; skipped");
        return;
    }
    for (const Known& known : {Known{"bitterli-cornell-box/scene.gltf", 36, 0},
                               Known{"bitterli-cornell-box/scene.obj", 36, 0},
                               Known{"cornell-mcguire/CornellBox-Original.obj", 36, 0},
                               Known{"cornell-tinyobj/cornell_box.obj", 36, 0},
                               Known{"cornell-bevy-lightmapped/CornellBox.glb", 36, 0},
                               Known{"cornell-nvpro/cornellBox.gltf", 16732, 464},
                               Known{"gltf-boxes/many-cubes.gltf", 6012, 0},
                               Known{"gltf-boxes/BoxVertexColors.glb", 12, 0},
                               Known{"mgf-classroom/scene.gltf", 9253, 0},
                               Known{"bitterli-modern-hall/scene.gltf", 31087, 2432},
                               Known{"bitterli-modern-hall/scene.obj", 31087, 2432},
                               Known{"urban-udales-949/geom.949.STL", 22881, 0}}) {
        CAPTURE(known.file);
        Scene scene = load_scene(shared / known.file);
        CHECK(scene.triangles == known.triangles);
        CHECK(scene.zero_area == known.zero_area);
        CHECK(scene.surfaces.size() + parallelograms(scene) + known.zero_area == known.triangles);
    }
}

// Fails when E lacks its π, when strength is dropped, or when Ka is taken for emission.
TEST_CASE("real emitters have E = pi L") {
    if (!std::filesystem::exists(shared)) {
        MESSAGE("no scenes at " << shared.string() << "; skipped");
        return;
    }
    auto brightest = [](const Scene& scene) {
        Spectrum e;
        for (const Material& m : scene.materials)
            if (m.emission[0] > e[0])
                e = m.emission;
        return e;
    };
    Spectrum e = brightest(load_scene(shared / "cornell-mcguire/CornellBox-Original.obj"));
    CHECK(e[0] == doctest::Approx(17 * pi).epsilon(1e-6));
    CHECK(e[1] == doctest::Approx(12 * pi).epsilon(1e-6));
    CHECK(e[2] == doctest::Approx(4 * pi).epsilon(1e-6));
    e = brightest(load_scene(shared / "bitterli-cornell-box/scene.gltf"));
    CHECK(e[0] == doctest::Approx(17 * pi).epsilon(1e-6));
    CHECK(brightest(load_scene(shared / "cornell-tinyobj/cornell_box.obj"))[0] == 0);
}

// Fails when a check of an index, a span, a type or a cycle is removed: the file then crashes,
// loads nonsense for ever, or throws something else.
TEST_CASE("every broken file loads or is refused, in bounded time") {
    if (!std::filesystem::exists(shared / "broken")) {
        MESSAGE("no broken files at " << shared.string() << "; skipped");
        return;
    }
    std::size_t files = 0, refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shared / "broken")) {
        if (!entry.is_regular_file())
            continue;
        CAPTURE(entry.path().string());
        auto begin = std::chrono::steady_clock::now();
        refused += !fault_of(entry.path()).empty();
        std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        CHECK(seconds.count() < 2);
        ++files;
    }
    CHECK(files > 100);
    CHECK(refused > 100);
}
