#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

#include "parallux/lines.h"
#include "throughput/cases.h"

namespace parallux::throughput {

/// What Embree is given: the patches one by one, or the surfaces that they are cells of.
enum class Parts { patches, parents };

/// How Embree is asked. No choice is best for every scene: each is tried on every one.
struct EmbreeChoice {
    bool context_filter = false;  ///< the filter hangs on the query, not on the geometry
    bool occluded = false;        ///< any-hit query: does not order the children of a node
    bool all_quads = false;       ///< triangles as quads with a corner twice: one tree, not two
    int columns = 4;              ///< of a packet of 16 lines: 4 (4 × 4) or 16 (16 × 1)
};

/// One crossing as the filter keeps it.
struct RawHit {
    float t, u, v;
    std::uint32_t id;  ///< primitive, and from_behind

    static constexpr std::uint32_t from_behind = 0x80000000u;
};

/// All surfaces, or all patches, in Embree: robust mode, about the middle of the scene's bounds.
/// MEDIUM quality, since with HIGH a primitive may be met twice.
class EmbreeScene {
public:
    EmbreeScene(const Case& of, Parts parts, const EmbreeChoice& choice, RTCFilterFunctionN filter);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }
    const glm::dvec3& centre() const { return centre_; }
    /// What has to be added to a geometry's primitive numbers to make them all different.
    const std::uint32_t* first_of() const { return first_of_; }

    Hit hit(const RawHit& raw) const {
        const std::uint32_t id = raw.id & ~RawHit::from_behind;
        std::uint32_t front = id, back = none;
        if (!own_numbers_) {
            const Primitive& p = primitives_[id];
            std::uint32_t cell = 0;
            if (p.nu * p.nv > 1)
                cell = cell_at(p.shape, p.nu, p.nv, raw.u, raw.v);
            front = p.front + cell;
            back = p.back == none ? none : p.back + cell;
        }
        // Met from behind: the traveller comes upon the back and leaves the front.
        const bool behind = raw.id & RawHit::from_behind;
        return {raw.t, id, behind ? back : front, behind ? front : back};
    }

private:
    struct Primitive {
        std::uint32_t front, back, nu, nv;
        Shape shape;
    };
    struct Mesh;

    void attach(const Mesh& mesh, unsigned geometry_id, const EmbreeChoice& choice,
                RTCFilterFunctionN filter);

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    glm::dvec3 centre_{0};
    std::vector<Primitive> primitives_;
    std::uint32_t first_of_[2] = {0, 0};
    bool own_numbers_ = false;  ///< primitives are numbered as patches are: nothing to look up
};

}  // namespace parallux::throughput
