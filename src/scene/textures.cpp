#include "scene/textures.h"

#include <cmath>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "parallux/error.h"
#include "scene/input.h"

namespace parallux {
namespace {

const char* format_of(std::string_view bytes) {
    auto starts = [&](std::string_view magic) { return bytes.substr(0, magic.size()) == magic; };
    if (starts("\x89PNG\r\n\x1a\n"))
        return "png";
    if (starts("\xFF\xD8\xFF"))
        return "jpeg";
    if (starts("\x76\x2f\x31\x01"))
        return "openexr";
    if (starts("#?RADIANCE") || starts("#?RGBE"))
        return "hdr";
    return nullptr;
}

float srgb_to_linear(float x) {
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// Pictures of whole numbers are display-referred; those of floats hold light itself.
bool is_display_referred(const OIIO::ImageSpec& spec) {
    return !spec.format.is_floating_point();
}

void read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, Texture& texture) {
    int channels = spec.nchannels >= 3 ? 3 : 1;
    texture.texels.resize(std::size_t(texture.width) * texture.height);
    if (!input.read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, texture.texels.data(),
                          sizeof(glm::vec3)))
        throw std::runtime_error(input.geterror());
    bool decode = is_display_referred(spec);
    for (glm::vec3& t : texture.texels)
        for (int c = 0; c < 3; ++c) {
            float x = c < channels ? t[c] : t[0];
            if (!(x >= 0))  // NaN and negative light
                x = 0;
            t[c] = decode && c < channels ? srgb_to_linear(x) : std::min(x, 1e15f);
        }
}

}  // namespace

Texture decode_picture(const std::filesystem::path& file, const std::string& place,
                       const std::string& bytes, std::uint64_t limit) {
    static const bool limits_set =
        OIIO::attribute("limits:imagesize_MB", 4096) && OIIO::attribute("limits:channels", 64);
    (void)limits_set;
    const char* format = format_of(bytes);
    if (format == nullptr)
        input_error(file, place, "not a PNG, JPEG, OpenEXR or Radiance HDR picture");
    try {
        auto input = OIIO::ImageInput::create(format);
        if (!input)
            throw std::runtime_error(OIIO::geterror());
        OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());
        OIIO::ImageSpec config, spec;
        config["oiio:UnassociatedAlpha"] = 1;  // alpha is ignored, so it must not darken
        input->set_ioproxy(&memory);
        if (!input->open("scene." + std::string(format), spec, config))
            throw std::runtime_error(input->geterror());
        if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || spec.nchannels < 1 ||
            spec.width > 16384 || spec.height > 16384 ||
            std::uint64_t(spec.width) * std::uint64_t(spec.height) > limit)
            throw std::runtime_error(std::to_string(spec.width) + " x " +
                                     std::to_string(spec.height) + " texels are too many");
        Texture texture;
        texture.width = static_cast<std::uint32_t>(spec.width);
        texture.height = static_cast<std::uint32_t>(spec.height);
        read_pixels(*input, spec, texture);
        return texture;
    } catch (const std::exception& error) {
        input_error(file, place, std::string("picture cannot be read: ") + error.what());
    }
}

std::uint32_t TextureReader::read(const std::string& place, const std::string& uri) {
    if (auto found = known_.find(uri); found != known_.end())
        return found->second;
    std::uint32_t index = none;
    auto path = resolve_below(scene_.file, place, uri);  // a path that leads out is refused
    try {
        index = add(uri, place, read_file(path, std::uint64_t(1) << 30));
    } catch (const Error& error) {
        scene_.warnings.push_back(std::string(error.what()) + "; its factor alone is used");
    }
    return known_[uri] = index;
}

std::uint32_t TextureReader::read_bytes(const std::string& key, const std::string& place,
                                        const std::string& bytes) {
    if (auto found = known_.find(key); found != known_.end())
        return found->second;
    std::uint32_t index = none;
    try {
        index = add(key, place, bytes);
    } catch (const Error& error) {
        scene_.warnings.push_back(std::string(error.what()) + "; its factor alone is used");
    }
    return known_[key] = index;
}

std::uint32_t TextureReader::add(const std::string& name, const std::string& place,
                                 const std::string& bytes) {
    Texture texture = decode_picture(scene_.file, place, bytes, max_texels - texels_);
    texels_ += texture.texels.size();
    texture.name = printable(name);
    scene_.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

}  // namespace parallux
