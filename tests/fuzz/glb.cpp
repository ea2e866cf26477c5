#include "scene_bytes.h"

// Where the input is no container, one is put round it: its lengths would else hide all the rest.
// Text up to the last closing brace is its JSON, what follows its binary chunk.

namespace {

std::string word(std::size_t value) {
    std::string bytes;
    for (int k = 0; k < 4; ++k)
        bytes += static_cast<char>(value >> (8 * k) & 255);
    return bytes;
}

std::string contained(const std::string& bytes) {
    const std::size_t end = std::min(bytes.rfind('}'), bytes.size() - 1) + 1;
    std::string json = bytes.substr(0, end), binary = bytes.substr(end);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" +
           json + word(binary.size()) + std::string("BIN\0", 4) + binary;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (size > 0 && bytes.compare(0, 4, "glTF") != 0)
        bytes = contained(bytes);
    return parallux::fuzz::read_scene_bytes("scene.glb", std::move(bytes));
}
