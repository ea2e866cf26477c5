#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/factors_options.h"
#include "parallux/parallux.h"

// What the user typed, checked as far as it can be without the scene.

namespace parallux {

enum class Command { print, info, solve, reuse, compare, factors };
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

/// What is changed of a scene before it is solved.
struct SceneChanges {
    std::filesystem::path materials;  ///< table of values by material; empty: none
    std::uint32_t bands = 0;          ///< 0: as the scene or the table has
    std::vector<std::string> exclude;
    std::filesystem::path temperatures;  ///< empty: no long-wave exchange
    double sky_temperature = 0;          ///< kelvin
};

struct SolveOptions {
    std::filesystem::path scene;
    LoadSettings load;
    SceneChanges changes;
    PatchSettings patches;
    SolveSettings solve;
    PictureSettings picture;
    std::string camera;  ///< name or index; "": the first
    std::vector<std::filesystem::path> images;
    double refresh = 0;  ///< seconds between pictures while the run goes on; 0: none
    std::vector<std::filesystem::path> bakes;
    BakeSettings bake = {.textures = true};  ///< of glTF; PLY knows no textures
    LightmapSettings lightmap_settings;
    std::filesystem::path table, stats, lightmap;  ///< empty: not wanted
    /// Of by_object, one an object that has surfaces: set when the scene is known.
    std::vector<std::filesystem::path> object_lightmaps;
    std::vector<std::string> receivers;  ///< of the table; empty: all
    std::filesystem::path fluxes;        ///< empty: not wanted
    FluxUnit flux_unit = FluxUnit::object;
    std::filesystem::path sensors, sensor_table;  ///< empty: none
    SensorSettings sensing;
    std::filesystem::path save;    ///< the solution in a file; empty: not wanted
    std::filesystem::path result;  ///< such a file that outputs are made from; empty: solve
    /// What was typed of scene, its changes and patches, without the scene's name.
    std::vector<std::string> scene_arguments;
    ProgressMode progress = ProgressMode::automatic;
    bool quiet = false;

    /// Every file to be written.
    std::vector<std::filesystem::path> outputs() const;
    /// Every file to be read.
    std::vector<std::filesystem::path> inputs() const;
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
    SolveOptions reuse;
    CompareOptions compare;
    FactorsOptions factors;
};

/// Reads the command line. Lengths are scaled to metres. Throws Fault::usage naming the option and
/// the value.
Options parse_options(int argc, const char* const* argv);

/// What single options cannot know of each other; lengths become metres. Once. Throws Fault::usage.
void settle(SolveOptions& options);

}  // namespace parallux
