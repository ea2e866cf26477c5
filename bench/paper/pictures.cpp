#include "paper/pictures.h"

#include "parallux/parallux.h"

namespace parallux::paper {

namespace {

// Means over the patches of walls, large cube and small cubes, which differ in area.
void count_lines(const Patches& patches, const Solution& solution, PictureRun& run) {
    double sums[3] = {}, counts[3] = {};
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        const int kind = patches.area[patch] > 6e-4 ? 0 : patches.area[patch] > 4e-4 ? 1 : 2;
        sums[kind] += static_cast<double>(solution.crossings[patch]);
        ++counts[kind];
    }
    run.walls = sums[0] / counts[0];
    run.large_cube = sums[1] / counts[1];
    run.small_cubes = sums[2] / counts[2];
}

}  // namespace

std::vector<PictureRun> draw_pictures(const std::string& scenes, const std::string& folder) {
    const Scene scene = load_scene(scenes + "/paper_12150.json");
    const Patches patches = make_patches(scene);
    std::vector<PictureRun> runs = {
        {5, 8'000'000, 12'000'000, 0, 0, 0, 0, 0, {1.38, 2.33, 1474, 1164, 655}, 0},
        {6, 16'000'000, 24'000'000, 0, 0, 0, 0, 0, {1.38, 2.33, 2948, 2328, 1310}, 0}};
    for (PictureRun& run : runs) {
        SolveSettings settings;
        settings.method = Method::lines;
        settings.first_shot = FirstShot::rays;
        settings.first_shot_rays = run.local_rays;
        settings.lines = run.lines;
        const Solution solution = solve(scene, patches, settings);
        const double hits = static_cast<double>(solution.counts.hits);
        run.list = hits / static_cast<double>(solution.counts.lines);
        run.nonempty_list = hits / static_cast<double>(solution.counts.nonempty);
        run.seconds = solution.seconds.first_shot + solution.seconds.global;
        count_lines(patches, solution, run);
        PictureSettings picture;
        picture.width = picture.height = 800;
        write_picture(folder + "/figure" + std::to_string(run.figure) + ".png",
                      render(scene, patches, solution, choose_camera(scene, ""), picture), picture);
    }
    return runs;
}

}  // namespace parallux::paper
