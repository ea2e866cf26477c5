#pragma once

#include "parallux/scene.h"

namespace parallux::throughput {

/// A closed room of small triangles with three balls and a ring in it: about 300 000 · fineness²
/// of them, one-sided, every edge shared by two. Walls are gently bumped, so that no two triangles
/// lie in one plane. The same bits on every call.
Scene make_room(double fineness);

}  // namespace parallux::throughput
