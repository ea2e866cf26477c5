#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace parallux::paper {

/// One of the paper's pictures: figure 5 or 6, and what it prints about the lines.
struct PictureRun {
    int figure = 0;
    std::uint64_t local_rays = 0, lines = 0;
    double list = 0, nonempty_list = 0;                 ///< average lengths
    double walls = 0, large_cube = 0, small_cubes = 0;  ///< average lines a patch
    double printed[5] = {};                             ///< the same five in the paper
    double seconds = 0;
};

/// Solves the scene of 12150 patches bidirectionally with first shot by rays, as the paper's
/// figures 5 (8 + 12 million lines) and 6 (16 + 24), and draws FOLDER/figure5.png and figure6.png.
std::vector<PictureRun> draw_pictures(const std::string& scenes, const std::string& folder);

}  // namespace parallux::paper
