#pragma once

#include <array>
#include <functional>

#include "output/bake_values.h"

namespace parallux {

/// A corner of a face before vertices are shared.
struct BakeCorner {
    glm::dvec3 position{0}, normal{0};
    glm::vec3 colour{0};
    glm::vec2 uv0{0}, uv1{0}, uv2{0};  ///< as Bake has them
};

/// A planar face of three or four corners, seen counter-clockwise.
struct BakeFace {
    std::uint32_t object = none, material = 0;
    bool both_sides = false;
    std::array<BakeCorner, 4> corner;
    std::uint32_t count = 0;
};

/// Turns faces into parts whose corners share vertices where nothing parts them.
class BakeBuilder {
public:
    explicit BakeBuilder(Bake& bake);
    ~BakeBuilder();
    BakeBuilder(const BakeBuilder&) = delete;
    BakeBuilder& operator=(const BakeBuilder&) = delete;

    /// Cuts a quad along the diagonal from its second to its fourth corner, as scenes that join
    /// triangles to parallelograms had it.
    void add(const BakeFace& face);
    /// Fills the bake. Once, at the end.
    void finish();

private:
    struct Part;
    Part& part_of(const BakeFace& face);
    Bake& bake_;
    std::vector<Part> parts_;
};

/// The face of a whole surface (cell none) or of one of its cells: places, normals and the scene's
/// texture coordinates. The back's is turned round; corner k is then that of uv[k] of the front
/// still, in reverse order.
struct FaceFrame {
    BakeFace face;
    std::array<glm::dvec2, 4> uv{};  ///< of the face's corners, in its order
};
FaceFrame face_frame(const Scene& scene, const Patches& patches, std::uint32_t surface, bool back,
                     std::uint32_t cell);

/// The same for meshes of lightmaps: with the scene's own colours and second coordinates.
FaceFrame scene_frame(const Scene& scene, const Patches& patches, std::uint32_t surface, bool back);
/// Takes away from a finished mesh of such frames what the scene has no use for.
void drop_unused(const Scene& scene, Bake& mesh);

}  // namespace parallux
