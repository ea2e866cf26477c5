#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"

// Stage 7b: what remains, as tables.

namespace parallux {

/// Writes one row a patch in patch order, 9 significant digits:
/// patch,surface,name,material,iu,iv,x,y,z,nx,ny,nz,area,side, then per band b
/// reflectance_b,emission_b,irradiance_b,radiosity_b,stderr_b, and behind them, where light goes
/// through surfaces, transmittance_b for each. `side` is front or back; stderr_b
/// is empty when not estimated. `receivers`: only patches of these surfaces, one entry a surface;
/// empty: all. The file is whole or untouched; throws Fault::output.
void write_table(const std::filesystem::path& file, const Scene& scene, const Patches& patches,
                 const Solution& solution, const std::vector<bool>& receivers = {});

/// How two tables of the same patches differ in radiosity, over all bands.
struct Comparison {
    std::uint64_t patches = 0;
    double rms = 0;           ///< √(Σ A (B_a - B_b)² / Σ A), W/m²
    double relative_rms = 0;  ///< rms / √(Σ A B_b² / Σ A)
    double maximum = 0;       ///< largest |B_a - B_b|
    std::uint64_t maximum_patch = 0;
};

/// Reads two tables written by write_table; b is the reference. Throws Fault::input with file and
/// line where one is damaged, or where patches, areas or bands differ.
Comparison compare_tables(const std::filesystem::path& a, const std::filesystem::path& b);

/// Writes the run's statistics as one JSON object; keys as the README lists them.
void write_stats(const std::filesystem::path& file, const Scene& scene, const Patches& patches,
                 const SolveSettings& settings, const Solution& solution);

/// Names of the bands: r, g, b for three, else 0 … K-1.
std::string band_name(std::uint32_t bands, std::uint32_t band);

}  // namespace parallux
