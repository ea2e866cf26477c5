#include "scene_bytes.h"

// The folder holds a material file but no picture: decoding one takes a thousand times as long as
// the rest. Pictures are fuzzed in glTF.

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return parallux::fuzz::read_scene_bytes("meshes/scene.obj",
                                            {reinterpret_cast<const char*>(data), size});
}
