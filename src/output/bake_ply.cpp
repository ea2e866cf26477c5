#include <bit>
#include <cstring>

#include "output/bake_writers.h"

namespace parallux {

static_assert(std::endian::native == std::endian::little, "files here are little endian");

namespace {

std::string header(const Scene& scene, const Bake& bake, std::size_t triangles) {
    const BakeSettings& settings = bake.settings;
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    auto line = [&](const std::string& what) { text += what + "\n"; };
    line(std::string("comment parallux ") + PARALLUX_VERSION);
    line(std::string("comment quantity ") + quantity_name(settings.quantity));
    line(std::string("comment unit ") + quantity_unit(settings.quantity));
    line(scene.bands == 3 ? "comment colours linear Rec.709"
                          : "comment colours mean of " + std::to_string(scene.bands) + " bands");
    if (settings.unlit)
        line("comment exposed and clamped to 0 1: colour = factor * quantity, factor " +
             std::to_string(bake.factor));
    line("comment a two-sided surface is two faces where its sides differ");
    line("element vertex " + std::to_string(bake.positions.size()));
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"})
        line(std::string("property float ") + name);
    line("element face " + std::to_string(triangles));
    line("property list uchar uint vertex_indices");
    line("end_header");
    return text;
}

template <class T>
void append(std::string& bytes, const T& value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

}  // namespace

void write_ply(OutputFile& output, const Scene& scene, const Bake& bake) {
    std::size_t triangles = 0;
    for (const BakePart& part : bake.parts)
        triangles += part.indices.size() / 3;
    std::string bytes = header(scene, bake, triangles);
    auto flush = [&](std::size_t above) {
        if (bytes.size() > above) {
            output.write(bytes);
            bytes.clear();
        }
    };
    constexpr std::size_t chunk = std::size_t(1) << 20;
    for (std::size_t v = 0; v < bake.positions.size(); ++v) {
        for (const glm::vec3& triple : {bake.positions[v], bake.normals[v], bake.colours[v]})
            append(bytes, triple);
        flush(chunk);
    }
    for (const BakePart& part : bake.parts)
        for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
            append(bytes, std::uint8_t(3));
            for (std::size_t k = 0; k < 3; ++k)
                append(bytes, std::uint32_t(part.first_vertex + part.indices[i + k]));
            flush(chunk);
        }
    flush(0);
}

}  // namespace parallux
