#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "parallux/tables.h"

// The columns of a table of patches, for the writer and the reader alike.

namespace parallux {

inline constexpr std::size_t patch_column = 0, name_column = 2, material_column = 3,
                             area_column = 12, side_column = 13, place_columns = 14;
/// reflectance, emission, irradiance, radiosity, stderr
inline constexpr std::size_t columns_per_band = 5;

inline std::size_t radiosity_column(std::uint32_t band) {
    return place_columns + band * columns_per_band + 3;
}

inline bool is_stderr_column(std::uint32_t bands, std::size_t column) {
    return column >= place_columns && column < place_columns + bands * columns_per_band &&
           (column - place_columns) % columns_per_band == 4;
}

/// The names of all columns of a table of so many bands; where light goes through surfaces, with a
/// transmittance for each behind all others, so that those keep their places.
inline std::vector<std::string> table_columns(std::uint32_t bands, bool translucent) {
    std::vector<std::string> names = {"patch", "surface", "name", "material", "iu", "iv",   "x",
                                      "y",     "z",       "nx",   "ny",       "nz", "area", "side"};
    for (std::uint32_t band = 0; band < bands; ++band)
        for (const char* name : {"reflectance", "emission", "irradiance", "radiosity", "stderr"})
            names.push_back(std::string(name) + "_" + band_name(bands, band));
    for (std::uint32_t band = 0; translucent && band < bands; ++band)
        names.push_back("transmittance_" + band_name(bands, band));
    return names;
}

}  // namespace parallux
