#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"
#include "support/shaded_lamp.h"

namespace parallux::test {

inline const std::string file =
    (std::filesystem::temp_directory_path() / "parallux_checkpoint_test.plx").string();

inline Scene lit_room() {
    const Material wall = grey(0.6), lamp = grey(0.4, 2, true);
    Scene scene = room({wall, wall, wall, wall, wall, lamp}, 4);
    scene.bands = 3;
    add_turned_cube(scene, {0.4, 0.5, 0.45}, 0.3, 2, grey(0.8));
    add_turned_cube(scene, {0.2, 0.7, 0.2}, 0.1, 1, grey(0.5, 1));
    add_light_and_sky(scene);
    return scene;
}

// A run of some kind, and one after the other of its interruptions.
struct Kind {
    const char* name;
    Scene scene;
    SolveSettings settings;
};

inline std::vector<Kind> kinds() {
    SolveSettings usual;
    usual.bundles = 160;
    usual.groups = 3;
    std::vector<Kind> all(10, {"", lit_room(), usual});
    all[0].name = "exact first shots, sky and lights";
    all[1].name = "rays, as many as a trial tells";
    for (std::size_t s = 0; s < 300; ++s)  // too many surfaces for exact ones
        add_quad(all[1].scene, {0.1, 0.1, 0.05 + 0.001 * double(s)}, {0.01, 0, 0}, {0, 0.01, 0});
    all[2].name = "rays in slabs";
    all[2].settings.first_shot = FirstShot::rays;
    all[2].settings.first_shot_rays = 3 << 19;
    all[3].name = "rounds to a stated error";
    all[3].settings = {};
    all[3].settings.target_error = 0.004;
    all[4].name = "shots from the brightest";
    all[4].settings.shots = 9;
    all[5].name = "lines in batches, one direction";
    all[5].settings = {};
    all[5].settings.method = Method::lines;
    all[5].settings.direction = Direction::oriented;
    all[5].settings.bundles = 100;
    all[5].settings.batch = 8;
    all[5].settings.first_shot = FirstShot::off;
    all[6].name = "patches too small for lines";
    all[6].scene = shaded_lamp();
    all[6].settings.bundles = 256;
    all[6].settings.groups = 2;
    all[6].settings.first_shot = FirstShot::rays;
    all[6].settings.first_shot_rays = 20000;
    all[7].name = "lights alone, whose direct light all groups share";
    all[7].settings.first_shot = FirstShot::off;
    all[8].name = "large batches, so that all workers keep lines, and no gather";
    for (Surface& surface : all[8].scene.surfaces)
        surface.grid_u = surface.grid_v = 16;
    all[8].settings.first_shot = FirstShot::off;
    all[8].settings.batch = 32;
    all[8].settings.groups = 1;
    all[8].settings.gather_share = 0;
    all[9].name = "few bundles, of which most gather, with quanta of their own";
    all[9].scene = room({grey(0.7), grey(0.7), grey(0.7), grey(0.7), grey(0.7), grey(0.7, 20)}, 3);
    all[9].settings = {};
    all[9].settings.bundles = 64;
    all[9].settings.batch = 1;
    all[9].settings.gather_share = 0.8;
    return all;
}

// How often a run asks whether to go on.
inline std::uint64_t answers(const Kind& kind, const Patches& patches) {
    std::uint64_t count = 0;
    solve(kind.scene, patches, kind.settings, [&](const Progress&) { return ++count > 0; });
    return count;
}

// A small run that was stopped within its second group's pass.
inline Kind stopped_run(int answers = 20) {
    Kind kind{"", room(grey(0.5, 1), 1), {}};
    kind.settings.bundles = 64;
    kind.settings.groups = 2;
    kind.settings.checkpoints.file = file;
    int calls = 0;
    solve(kind.scene, make_patches(kind.scene), kind.settings,
          [&](const Progress&) { return ++calls < answers; });
    return kind;
}

}  // namespace parallux::test
