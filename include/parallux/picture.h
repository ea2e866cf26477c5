#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"

// Stage 7a: what remains, as a picture.

namespace parallux {

struct PictureSettings {
    std::uint32_t width = 1024;
    std::uint32_t height = 0;        ///< 0: from the camera's aspect (square where it has none)
    std::uint32_t samples = 16;      ///< a pixel, at least 16 by default
    bool flat = false;               ///< show the patches unsmoothed
    double exposure = 0;             ///< stops, on top of the automatic one
    bool automatic_exposure = true;  ///< PNG: bring the picture's log-mean to middle grey
    bool filmic = true;              ///< PNG: filmic curve; else clamped
    /// PNG: one band, shown in grey, or three as red, green and blue; empty: all of a picture that
    /// has one or three.
    std::vector<std::uint32_t> shown_bands;
    unsigned threads = 0;
};

/// Layers of one picture, row 0 at the top, `width * height` pixels; per band values lie together.
struct Picture {
    std::uint32_t width = 0, height = 0, bands = 0;
    std::vector<float> radiance;  ///< per band, W/(m² sr): B/π of what is seen, or the sky
    std::vector<float> display;   ///< radiance averaged for the screen: bright samples weigh less,
                                  ///< so that the edges of lights stay smooth; PNG only
    std::vector<float> alpha;     ///< share of the samples that met a surface
    std::vector<float> irradiance;  ///< per band, W/m², interpolated
    std::vector<float> albedo;      ///< per band
    std::vector<float> normal;      ///< 3 a pixel, world, towards the camera
    std::vector<float> patch;       ///< patch id at the pixel's centre; -1: none
    /// Per band, W/m²: standard error of the radiosity B of the patches that the samples see, as
    /// the solution states it; 0 where they see none. Not smoothed: what a value that is
    /// interpolated from several patches errs by, the solution does not tell. Beside radiance it
    /// has to be divided by π. Empty when the solution has none.
    std::vector<float> stderror;
};

/// The camera to use: by name, else by index; "" gives the first, or one that shows the whole scene
/// when it has none. Throws Fault::usage naming those there are.
Camera choose_camera(const Scene& scene, const std::string& name_or_index);

/// Casts camera rays and shades them with B = E + ρ H: irradiance interpolated across each smooth
/// surface, reflectance and emission at the very point. Same bits for any number of threads.
Picture render(const Scene& scene, const Patches& patches, const Solution& solution,
               const Camera& camera, const PictureSettings& settings);

/// Writes .exr (linear radiance and all layers, float) or .png (exposed and tone-mapped, 8 bit
/// sRGB). The file is whole or untouched; throws Fault::output. EXR has one channel a band and
/// layer, R, G, B of three, else 0 … K-1. PNG of other than one or three bands needs shown_bands;
/// throws Fault::usage without.
void write_picture(const std::filesystem::path& file, const Picture& picture,
                   const PictureSettings& settings);

}  // namespace parallux
