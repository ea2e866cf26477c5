#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lines/ray_scene.h"
#include "parallux/lines.h"

namespace parallux {

/// Lines of a run in the order of their numbers.
struct LineStream {
    const RayScene& rays;
    const Scene& scene;
    const Patches& patches;
    LineSphere sphere;
    std::uint64_t seed = 1;
    std::uint64_t lines = 0;
    bool directions = false;  ///< give them too
    unsigned threads = 0;
};

/// Traces lines 0 … lines - 1 on all threads and hands their lists, in order, to `follow` on the
/// calling thread: follow(lists, directions, lines before these). False ends the stream. Returns
/// the lines that were handed over.
std::uint64_t trace_in_order(
    const LineStream& stream,
    const std::function<bool(const IntersectionLists&, const std::vector<glm::dvec3>&,
                             std::uint64_t)>& follow);

}  // namespace parallux
