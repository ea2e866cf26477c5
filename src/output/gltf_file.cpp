#include "output/gltf_file.h"

#include <algorithm>
#include <cstring>

#include "parallux/error.h"

namespace parallux {

namespace {

using Json = GltfFile::Json;

std::string base64(const std::string& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t triple = 0;
        for (std::size_t k = 0; k < 3; ++k)
            triple =
                triple << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[triple >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string word(std::size_t value) {
    std::string bytes(4, '\0');
    const auto narrow = static_cast<std::uint32_t>(value);
    std::memcpy(bytes.data(), &narrow, 4);
    return bytes;
}

}  // namespace

GltfFile::GltfFile(const Json& extras) {
    json_["asset"] = {{"version", "2.0"},
                      {"generator", std::string("Parallux ") + PARALLUX_VERSION},
                      {"extras", extras}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", Json::array()}}});
    json_["nodes"] = json_["meshes"] = json_["materials"] = json_["accessors"] =
        json_["bufferViews"] = Json::array();
}

std::size_t GltfFile::add(const char* array, Json element) {
    json_[array].push_back(std::move(element));
    return json_[array].size() - 1;
}

std::size_t GltfFile::add_view(std::string_view bytes, std::size_t stride, int target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);  // floats begin at whole words
    Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
    if (stride > 0)
        view["byteStride"] = stride;
    if (target != 0)
        view["target"] = target;
    bytes_ += bytes;
    return add("bufferViews", std::move(view));
}

std::size_t GltfFile::add_picture(const std::string& name, std::string_view png) {
    const std::size_t view = add_view(png, 0, 0);
    const std::size_t image =
        add("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
    return add("textures", {{"source", image}});
}

void GltfFile::use(const char* extension) {
    if (std::find(extensions_.begin(), extensions_.end(), extension) == extensions_.end())
        extensions_.push_back(extension);
}

std::string GltfFile::text(const std::string& buffer_uri) {
    if (!extensions_.empty())
        json_["extensionsUsed"] = extensions_;
    Json buffer = {{"byteLength", bytes_.size()}};
    if (!buffer_uri.empty())
        buffer["uri"] = buffer_uri;
    json_["buffers"] = Json::array({buffer});
    // Names may hold any bytes; JSON may not.
    return json_.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void GltfFile::write(OutputFile& output, const std::filesystem::path& file, bool glb) {
    if (!glb)
        return output.write(text("data:application/octet-stream;base64," + base64(bytes_)) + "\n");
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    std::string json = text({});
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + json.size() + 8 + bytes_.size();
    if (total > 0xffffffffu)
        throw Error(Fault::output, file.string() +
                                       ": a GLB holds 4 GiB and this bake needs more; "
                                       "use larger patches or --bake-mesh original");
    output.write("glTF" + word(2) + word(total) + word(json.size()) + "JSON");
    output.write(json);
    output.write(word(bytes_.size()) + std::string("BIN\0", 4));
    output.write(bytes_);
}

}  // namespace parallux
