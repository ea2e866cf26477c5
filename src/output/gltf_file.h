#pragma once

#include <bit>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "output/output_file.h"

// Khronos Group, glTF 2.0 specification, 2021, sections 3 (JSON) and 4 (GLB).

namespace parallux {

static_assert(std::endian::native == std::endian::little, "files here are little endian");

/// A glTF document under way, with its one buffer.
class GltfFile {
public:
    using Json = nlohmann::ordered_json;

    explicit GltfFile(const Json& extras);

    Json& operator[](const char* key) { return json_[key]; }

    /// Adds to one of the document's arrays; returns its index.
    std::size_t add(const char* array, Json element);
    /// Values of vertices, or indices, into the buffer; returns the view.
    template <class T>
    std::size_t add_values(const std::vector<T>& values, bool of_vertices) {
        const std::span<const std::byte> raw = std::as_bytes(std::span(values));
        return add_view({reinterpret_cast<const char*>(raw.data()), raw.size()},
                        of_vertices ? sizeof(T) : 0, of_vertices ? 34962 : 34963);
    }
    /// A PNG file's bytes; returns the texture, which repeats.
    std::size_t add_picture(const std::string& name, std::string_view png);
    void use(const char* extension);

    /// GLB, or JSON with the buffer as a data URI; does not commit. Throws Fault::output, naming
    /// the file, above the 4 GiB that GLB can hold.
    void write(OutputFile& output, const std::filesystem::path& file, bool glb);

private:
    std::size_t add_view(std::string_view bytes, std::size_t stride, int target);
    std::string text(const std::string& buffer_uri);

    Json json_;
    std::string bytes_;
    std::vector<std::string> extensions_;
};

}  // namespace parallux
