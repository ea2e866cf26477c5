#include "scene_bytes.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return parallux::fuzz::read_scene_bytes("scene.stl",
                                            {reinterpret_cast<const char*>(data), size});
}
