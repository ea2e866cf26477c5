#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/solve.h"

// Between stages 6 and 7: a solution in a file, so that outputs can be made without solving again.

namespace parallux {

/// A solution and what it belongs to.
struct SavedSolution {
    std::string version;      ///< of the program that solved it
    std::uint64_t scene = 0;  ///< scene_hash() of scene and patches
    /// Whatever makes equal patches of the scene's file again; the program keeps its options here.
    std::vector<std::string> arguments;
    SolveSettings settings;  ///< method, seed and target_error; the others are not kept
    Solution solution;       ///< without crossings
};

/// Over all that outputs and patches are made of: surfaces, materials, textures, names, lights,
/// sky, period, and the patches. Not over the file's name, cameras, warnings and lightmap_uv: a
/// scene may get new cameras, or another format. Linear.
std::uint64_t scene_hash(const Scene& scene, const Patches& patches);

/// Writes one binary file with a format's number, a length and a checksum. The file is whole or
/// untouched; throws Fault::output.
void write_result(const std::filesystem::path& file, const SavedSolution& result);

/// Reads it back. Every count is compared with the bytes there are before anything is taken. Throws
/// Fault::input for a file that is none, of another format, cut, longer, or changed in any byte.
SavedSolution read_result(const std::filesystem::path& file);

/// Throws Fault::input, naming both hashes, unless the result is of these patches of this scene.
void check_result(const std::filesystem::path& file, const SavedSolution& result,
                  const Scene& scene, const Patches& patches);

}  // namespace parallux
