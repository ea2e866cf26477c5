#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/scene.h"

// Between stages 1 and 2: what a user changes of a scene without touching its file.

namespace parallux {

/// Gives a scene's materials the values of a CSV table: `material`, then `reflectance_b` or
/// `emission_b` or both, and `transmittance_b`, `back_reflectance_b`, `back_transmittance_b`, b
/// from 0 to K-1 (r, g, b where K is 3); reflectance from 0 to below 1, emission E in W/m². A
/// listed material has these values alone: its textures and vertex colours give way, with a
/// warning, and what the table has no columns for stays. The scene has K bands from then on. What
/// is not listed keeps its values; where K is not the scene's own they must be the same in all its
/// bands, as must those of lights and sky. `bands`: the K that is asked for; 0: the table's. Throws
/// Fault::input for damage, names that the scene does not have and values that are missing,
/// Fault::usage when the table has another number of bands than is asked for.
void set_materials(Scene& scene, const std::filesystem::path& csv, std::uint32_t bands = 0);

/// Solves a scene in so many bands, 1 to 8: its own number, or another where all values are the
/// same in all its bands; else throws Fault::input naming what has more than one.
void set_bands(Scene& scene, std::uint32_t bands);

/// Whether a name fits a pattern, in which * stands for any text and ? for any byte.
bool name_fits(const std::string& name, const std::string& pattern);

/// The surfaces whose object's or material's name fits one of the patterns. `option` names them
/// when one fits nothing, which throws Fault::usage.
std::vector<bool> named_surfaces(const Scene& scene, const std::vector<std::string>& patterns,
                                 const std::string& option);

/// Takes such surfaces out of the scene. Throws Fault::usage when nothing would be left.
void exclude_surfaces(Scene& scene, const std::vector<std::string>& patterns);

}  // namespace parallux
