#pragma once

#include <glm/mat4x4.hpp>

#include "scene/gltf_document.h"
#include "scene/loaders.h"

namespace parallux {

/// A node's own transform, from its matrix or its translation, rotation and scale.
glm::dmat4 node_transform(const JsonView& node);

/// The camera or light that a node carries, placed by the node's world transform and scaled.
void add_gltf_camera(Scene& scene, const GltfDocument& document, const JsonView& node,
                     const glm::dmat4& world, double scale);
void add_gltf_light(Scene& scene, const JsonView& root, const JsonView& node,
                    const glm::dmat4& world, double scale);

}  // namespace parallux
