#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "parallux/scene.h"
#include "scene/json_view.h"

namespace parallux {

/// A glTF 2.0 file (.gltf or .glb) with its buffers. Every count, offset, stride and index is
/// checked against the bytes present before anything is taken: tinygltf, the usual reader, leaves
/// all of that to its caller and wants the whole JSON validated beforehand, so the JSON is read
/// directly.
class GltfDocument {
public:
    /// Throws Fault::input for containers and JSON that are broken, versions other than 2 and
    /// required extensions that are not supported.
    GltfDocument(std::filesystem::path file, std::string bytes);
    GltfDocument(const GltfDocument&) = delete;

    JsonView root() const { return JsonView(file_, json_); }
    /// The element of a top-level list that `index` (a value in the file) points to.
    JsonView element(const char* list, const JsonView& index) const;
    JsonView element(const char* list, std::uint64_t index) const;
    std::uint64_t length(const char* list) const;

    /// Bytes of a buffer view; buffers are loaded on first use.
    std::string_view view_bytes(const JsonView& index);

    /// An accessor's values as floats, `components` of them (2 to 4) an element; normalised
    /// integers become fractions. Returns the components in `components`.
    std::vector<float> read_floats(const JsonView& index, std::uint32_t& components);
    /// An accessor of unsigned whole numbers.
    std::vector<std::uint32_t> read_indices(const JsonView& index);

private:
    struct Layout {
        std::string_view bytes;  ///< from the first element on; empty: all zero
        std::uint64_t stride = 0;
        std::uint64_t count = 0;
        std::uint64_t component_type = 0;
        std::uint32_t components = 0;
        bool normalized = false;
    };
    Layout layout(const JsonView& accessor);
    std::string_view span(const JsonView& owner, std::uint64_t count, std::uint64_t element_bytes,
                          std::uint64_t& stride);
    std::string_view buffer(const JsonView& index);
    void split_glb(const std::string& bytes);
    void check_extensions() const;

    std::filesystem::path file_;
    Json json_;
    std::string binary_;  ///< the GLB's own chunk
    bool has_binary_ = false;
    std::vector<std::string> buffers_;
    std::vector<bool> loaded_;
    std::uint64_t elements_read_ = 0;  ///< bounds the work of a hostile file
};

}  // namespace parallux
