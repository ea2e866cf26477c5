#pragma once

#include <map>
#include <string>

#include "parallux/scene.h"

namespace parallux {

/// Reads pictures into Scene::textures, each file once. A picture that is absent or broken leaves
/// a warning and `none`: the factor alone then counts.
class TextureReader {
public:
    explicit TextureReader(Scene& scene) : scene_(scene) {}

    /// A file named by `uri` at `place` of the scene file.
    std::uint32_t read(const std::string& place, const std::string& uri);
    /// A picture in memory: `key` tells equal ones apart.
    std::uint32_t read_bytes(const std::string& key, const std::string& place,
                             const std::string& bytes);

private:
    std::uint32_t add(const std::string& name, const std::string& place, const std::string& bytes);

    Scene& scene_;
    std::map<std::string, std::uint32_t> known_;
    std::uint64_t texels_ = 0;
};

/// Decodes a PNG, JPEG, OpenEXR or Radiance HDR picture, known by its first bytes; other readers
/// stay closed. Files of 8 and 16 bits hold sRGB and become linear. Throws Fault::input with `file`
/// and `place` and why; nothing above `max_texels` is read.
Texture decode_picture(const std::filesystem::path& file, const std::string& place,
                       const std::string& bytes, std::uint64_t max_texels);

/// The most texels of one picture and of a scene: 1.6 GB as floats.
inline constexpr std::uint64_t max_texels = std::uint64_t(1) << 27;

}  // namespace parallux
