#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"

// Stage 7c: what remains, at points that are no patches.

namespace parallux {

/// A point that measures irradiance on a plane; it casts no shadow.
struct Sensor {
    std::string name;
    glm::dvec3 position{0};  ///< metres
    glm::dvec3 normal{0};    ///< unit
};

struct SensorSettings {
    std::uint64_t rays = 16384;  ///< a sensor: half to the sources, half by the cosine law
    std::uint64_t seed = 1;
    unsigned threads = 0;
};

/// One value a sensor and band, sensor * bands + band, W/m².
struct SensorReadings {
    std::uint32_t bands = 0;
    std::vector<double> irradiance;
    std::vector<double> stderror;        ///< of the rays, from 16 independent parts of them
    std::vector<double> solution_error;  ///< the most that the solution's own standard errors can
                                         ///< add, as if all patches that are seen erred alike;
                                         ///< empty when it states none
};

/// Reads `x,y,z,nx,ny,nz` and, where there is one, `name` (else the row's number); positions in the
/// scene's units, `scale` metres each; normals of any length but 0. Throws Fault::input naming file
/// and line.
std::vector<Sensor> read_sensors(const std::filesystem::path& csv, double scale = 1);

/// Irradiance at each sensor by a final gather along local rays: lights without area and emission
/// found by rays to them, what patches reflect and the sky by rays of the cosine law; emission by
/// both, by the balance heuristic (E. Veach and L. Guibas, Optimally Combining Sampling Techniques
/// for Monte Carlo Rendering, 1995). Patches send the solution's B evenly from all their area, so
/// that near a patch, within about its size, a reading is as coarse as the patches. Sensors that
/// lie on a surface are taken as just above it. Linear in sensors and rays, in parallel, the same
/// bits for any number of threads. Throws Fault::usage for a scene that repeats.
SensorReadings sense(const Scene& scene, const Patches& patches, const Solution& solution,
                     const std::vector<Sensor>& sensors, const SensorSettings& settings = {});

/// Writes `sensor,x,y,z,nx,ny,nz` and per band `irradiance_b,stderr_b,solution_stderr_b`, 9
/// significant digits, positions in metres. The file is whole or untouched; throws Fault::output.
void write_sensors(const std::filesystem::path& file, const std::vector<Sensor>& sensors,
                   const SensorReadings& readings);

}  // namespace parallux
