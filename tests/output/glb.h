#pragma once

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

// Reads back what bakes write, without the program's own reader.

namespace parallux::test {

inline std::string bytes_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

struct Glb {
    nlohmann::json json;
    std::string binary;

    explicit Glb(const std::string& file) {
        std::string bytes = bytes_of(file);
        REQUIRE(bytes.size() > 20);
        REQUIRE(bytes.substr(0, 4) == "glTF");
        REQUIRE(word(bytes, 8) == bytes.size());
        std::uint32_t size = word(bytes, 12);
        REQUIRE(bytes.substr(16, 4) == "JSON");
        json = nlohmann::json::parse(bytes.substr(20, size));
        REQUIRE(word(bytes, 20 + size) == bytes.size() - 28 - size);
        binary = bytes.substr(28 + size);
    }

    template <class T>
    std::vector<T> values(std::size_t accessor) const {
        const auto& a = json["accessors"][accessor];
        const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        std::size_t at = view["byteOffset"].get<std::size_t>() + a.value("byteOffset", 0u);
        std::vector<T> result(a["count"].get<std::size_t>());
        REQUIRE(at + result.size() * sizeof(T) <= binary.size());
        std::memcpy(result.data(), binary.data() + at, result.size() * sizeof(T));
        return result;
    }

    /// Calls visit(primitive, triangle's three vertices) for every triangle.
    template <class Visit>
    void triangles(Visit&& visit) const {
        for (const auto& mesh : json["meshes"])
            for (const auto& primitive : mesh["primitives"]) {
                auto indices = values<std::uint32_t>(primitive["indices"]);
                for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
                    visit(primitive["attributes"],
                          std::array{indices[i], indices[i + 1], indices[i + 2]});
            }
    }

private:
    static std::uint32_t word(const std::string& bytes, std::size_t at) {
        std::uint32_t value;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    }
};

/// A binary PLY of bakes: nine floats a vertex, then triangles.
struct Ply {
    std::string header;
    std::vector<std::array<float, 9>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;

    explicit Ply(const std::string& file) {
        std::string bytes = bytes_of(file);
        std::size_t at = bytes.find("end_header\n");
        REQUIRE(at != bytes.npos);
        header = bytes.substr(0, at), at += 11;
        auto count = [&](const std::string& element) {
            return std::stoul(header.substr(header.find(element) + element.size()));
        };
        vertices.resize(count("element vertex "));
        faces.resize(count("element face "));
        REQUIRE(bytes.size() == at + 36 * vertices.size() + 13 * faces.size());
        std::memcpy(vertices.data(), bytes.data() + at, 36 * vertices.size());
        for (std::size_t f = 0; f < faces.size(); ++f)
            std::memcpy(&faces[f], bytes.data() + at + 36 * vertices.size() + 13 * f + 1, 12);
    }
};

}  // namespace parallux::test
