#pragma once

#include <cstdint>
#include <vector>

#include "parallux/factors.h"

namespace parallux {

/// The rows of the factors, and which one each patch belongs to.
struct NodeMap {
    std::vector<FactorNode> nodes;
    std::vector<std::uint32_t> of_patch;
};

/// Nodes in the order of patches, surfaces, objects or materials; those without patches are left
/// out. Linear.
NodeMap make_nodes(const Scene& scene, const Patches& patches, FactorNodes between);

}  // namespace parallux
