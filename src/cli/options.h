#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/factors_options.h"
#include "parallux/parallux.h"

// What the user typed, checked as far as it can be without the scene.

namespace parallux {

enum class Command { print, info, solve, compare, factors };
enum class ProgressMode { automatic, on, off, json };

struct InfoOptions {
    std::filesystem::path scene;
    LoadSettings load;
    bool json = false;
    bool predict = false;  ///< say how wrong how many lines will be
    PatchSettings patches;
    SolveSettings solve;  ///< of the lines: number, sphere; of the run: seed, threads
    double error = 0.01;  ///< relative RMS to give the lines for
};

struct SolveOptions {
    std::filesystem::path scene;
    LoadSettings load;
    PatchSettings patches;
    SolveSettings solve;
    PictureSettings picture;
    std::string camera;  ///< name or index; "": the first
    std::vector<std::filesystem::path> images;
    double refresh = 0;  ///< seconds between pictures while the run goes on; 0: none
    std::vector<std::filesystem::path> bakes;
    BakeSettings bake;
    LightmapSettings lightmap_settings;
    std::filesystem::path table, stats, lightmap;  ///< empty: not wanted
    ProgressMode progress = ProgressMode::automatic;
    bool quiet = false;

    /// Every file to be written.
    std::vector<std::filesystem::path> outputs() const;
};

struct CompareOptions {
    std::filesystem::path a, b;
    double tolerance = -1;  ///< of the relative RMS; < 0: none
};

struct Options {
    Command command = Command::print;
    std::string text;  ///< to print: help or version
    InfoOptions info;
    SolveOptions solve;
    CompareOptions compare;
    FactorsOptions factors;
};

/// Reads the command line. Lengths are scaled to metres. Throws Fault::usage naming the option and
/// the value.
Options parse_options(int argc, const char* const* argv);

}  // namespace parallux
