#include "scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "scene/input.h"

namespace parallux {
namespace {

constexpr std::array supported_extensions = {
    "KHR_materials_emissive_strength", "KHR_lights_punctual", "KHR_texture_transform",
    "KHR_mesh_quantization", "KHR_materials_unlit",
    // Only shine and colour of what is treated as diffuse anyway:
    "KHR_materials_transmission", "KHR_materials_specular", "KHR_materials_ior",
    "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_volume",
    "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_dispersion",
    "KHR_xmp_json_ld", "KHR_materials_variants", "EXT_texture_webp"};

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

}  // namespace

GltfDocument::GltfDocument(std::filesystem::path file, std::string bytes) : file_(std::move(file)) {
    if (bytes.compare(0, 4, "glTF") == 0)
        split_glb(bytes);
    else
        json_ = parse_json(file_, bytes);
    std::string version = root().at("asset").at("version").text();
    if (version.substr(0, 2) != "2.")
        root().at("asset").at("version").fail("glTF " + version + "; only version 2 is read");
    check_extensions();
    std::uint64_t count = length("buffers");
    buffers_.resize(count);
    loaded_.resize(count, false);
}

// Khronos Group, glTF 2.0 specification, section 4: header, JSON chunk, optional binary chunk.
void GltfDocument::split_glb(const std::string& bytes) {
    auto fail = [&](const std::string& what) { input_error(file_, "GLB container", what); };
    if (bytes.size() < 20)
        fail("ends within its header");
    if (little_endian(bytes, 4) != 2)
        fail("version " + std::to_string(little_endian(bytes, 4)) + "; only version 2 is read");
    std::size_t end = little_endian(bytes, 8);
    if (end > bytes.size())
        fail("is " + std::to_string(end) + " bytes by its header, but the file has " +
             std::to_string(bytes.size()) + "; it is cut short");
    bool has_json = false;
    for (std::size_t at = 12; at + 8 <= end;) {
        std::size_t size = little_endian(bytes, at);
        std::uint32_t type = little_endian(bytes, at + 4);
        if (size > end - at - 8)
            fail("chunk at byte " + std::to_string(at) + " is longer than the file");
        std::string_view chunk(bytes.data() + at + 8, size);
        if (!has_json) {
            if (type != 0x4E4F534A)
                fail("does not begin with a JSON chunk");
            json_ = parse_json(file_, chunk);
            has_json = true;
        } else if (type == 0x004E4942 && !has_binary_) {
            binary_ = chunk;
            has_binary_ = true;
        }
        at += 8 + size;
    }
    if (!has_json)
        fail("has no JSON chunk");
}

void GltfDocument::check_extensions() const {
    auto required = root().find("extensionsRequired");
    for (std::size_t i = 0; required && i < required->size(); ++i) {
        const std::string& name = required->at(i).text();
        if (std::find(supported_extensions.begin(), supported_extensions.end(), name) ==
            supported_extensions.end())
            required->at(i).fail("extension " + printable(name) +
                                 " is required and not supported; export without it");
    }
}

std::uint64_t GltfDocument::length(const char* list) const {
    auto found = root().find(list);
    return found ? found->size() : 0;
}

JsonView GltfDocument::element(const char* list, const JsonView& index) const {
    std::uint64_t i = index.count(std::uint64_t(1) << 32);
    if (i >= length(list))
        index.fail("points to " + std::string(list) + "/" + std::to_string(i) + ", but there are " +
                   std::to_string(length(list)));
    return element(list, i);
}

JsonView GltfDocument::element(const char* list, std::uint64_t index) const {
    return root().at(list).at(static_cast<std::size_t>(index));
}

std::string_view GltfDocument::buffer(const JsonView& index) {
    JsonView json = element("buffers", index);
    std::size_t i = index.count(std::uint64_t(1) << 32);
    std::uint64_t declared = json.at("byteLength").count(max_file_bytes);
    auto uri = json.find("uri");
    if (!uri && !(i == 0 && has_binary_))
        json.fail("has neither a uri nor the binary chunk of a .glb file");
    if (uri && !loaded_[i]) {
        buffers_[i] = is_data_uri(uri->text())
                          ? decode_data_uri(file_, uri->path(), uri->text())
                          : read_file(resolve_below(file_, uri->path(), uri->text()));
        loaded_[i] = true;
    }
    std::string_view bytes = uri ? std::string_view(buffers_[i]) : std::string_view(binary_);
    if (bytes.size() < declared)
        json.fail("byteLength is " + std::to_string(declared) + ", but only " +
                  std::to_string(bytes.size()) + " bytes are there; the file is cut short");
    return bytes.substr(0, declared);
}

std::string_view GltfDocument::view_bytes(const JsonView& index) {
    JsonView view = element("bufferViews", index);
    std::string_view bytes = buffer(view.at("buffer"));
    std::uint64_t offset = view.count_or("byteOffset", 0, max_file_bytes);
    std::uint64_t size = view.at("byteLength").count(max_file_bytes);
    if (offset > bytes.size() || size > bytes.size() - offset)
        view.fail("bytes " + std::to_string(offset) + " to " + std::to_string(offset + size) +
                  " of a buffer of " + std::to_string(bytes.size()));
    return bytes.substr(offset, size);
}

}  // namespace parallux
