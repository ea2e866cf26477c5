#pragma once

#include "cli/options.h"

namespace parallux {

/// Before anything is computed: every file can be written, no two are the same, none is an input,
/// of which the scene is one. Throws Fault::usage or Fault::output.
void check_files(const std::vector<std::filesystem::path>& files,
                 const std::vector<std::filesystem::path>& inputs,
                 const std::filesystem::path& scene);
/// The same of all that solve writes and reads.
void check_outputs(const SolveOptions& options);

/// Where a picture is wanted: the camera exists, or a warning says that the scene has none and how
/// to choose. Throws Fault::usage.
void check_camera(const SolveOptions& options, Scene& scene);

/// Draws the picture and writes it to every file wanted. A file that cannot be written keeps none
/// of the others back; the first failure is thrown at the end.
void write_images(const SolveOptions& options, const Scene& scene, const Patches& patches,
                  const Solution& solution);

/// The same for bakes.
void write_bakes(const SolveOptions& options, const Scene& scene, const Patches& patches,
                 const Solution& solution);

/// What outputs need beside the solution.
struct Measurements {
    std::vector<bool> receivers;  ///< the surfaces of the table; empty: all
    std::vector<Sensor> sensors;
    Fluxes fluxes;
};

/// Writes all that is wanted, the statistics last and with the time that the others took. A file
/// that cannot be written keeps none of the others back; the first failure is thrown at the end.
void write_outputs(const SolveOptions& options, const Scene& scene, const Patches& patches,
                   Solution& solution, const Measurements& measured);

/// Measures from the program's start, for Seconds.
double seconds_since_start();

}  // namespace parallux
