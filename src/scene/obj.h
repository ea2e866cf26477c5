#pragma once

#include <charconv>
#include <map>
#include <string>
#include <string_view>

#include "scene/loaders.h"
#include "scene/textures.h"

namespace parallux {

/// Whether a text's first line that says something begins with a keyword of OBJ.
bool looks_like_obj(const std::string& bytes);

/// One line of an OBJ or MTL file after another, in words; joins lines that end in a backslash.
class ObjLines {
public:
    ObjLines(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

    /// Goes to the next line that has a word; false at the end.
    bool next();
    std::string_view word();  ///< the next word of the line; empty at its end
    std::string rest();       ///< what is left of the line, trimmed
    double number();          ///< the next word as a number
    double number_or(double otherwise);
    [[noreturn]] void fail(const std::string& what) const;
    std::string place() const { return "line " + std::to_string(line_); }

private:
    std::filesystem::path file_;
    std::string_view text_, left_;
    std::string joined_;
    std::uint64_t line_ = 0, next_line_ = 1;
};

/// Reads the materials of an MTL file into the scene: Kd, map_Kd, Ke (a radiance: E = π Ke) and
/// map_Ke. Ka is ambient light of old renderers, no emission. A name that occurs again is replaced.
void read_mtl(SceneBuilder& builder, TextureReader& textures, const std::filesystem::path& file,
              const std::string& text, std::map<std::string, std::uint32_t>& materials);

}  // namespace parallux
