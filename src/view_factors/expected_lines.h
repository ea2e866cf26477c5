#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "parallux/lines.h"
#include "view_factors/nodes.h"

namespace parallux {

/// How many lines of a bundle leave each node on average over the offsets of the bundle, known
/// without lines: what the node's surfaces measure across the direction, in cells of the bundle.
class ExpectedLines {
public:
    ExpectedLines(const Scene& scene, const Patches& patches, const NodeMap& nodes);

    /// One value a node.
    void of(const Bundle& bundle, std::vector<double>& lines) const;
    static std::uint64_t bytes(std::size_t patches) { return patches * sizeof(Piece); }

private:
    struct Piece {
        std::uint32_t node;
        glm::dvec3 area;  // m², along the normal
    };
    void add_curved(const Curve& curve, const SurfaceGrid& grid, const NodeMap& nodes);

    std::vector<Piece> pieces_;
    std::size_t nodes_;
};

/// What each line of a node weighs, from how many there should be and how many there are. With many
/// lines on a node, their number is noise and no more: they are made to weigh what they should.
/// With few it must not be so: a node that is met by chance weighs nothing where it is not met, and
/// the directions that meet it more often would weigh too little. In between some of each, by the
/// expected number alone, which leaves the mean what it should be.
inline double line_weight(double expected, double met) {
    constexpr double few = 2, many = 4;
    if (expected <= few || met == 0)
        return 1;
    const double t = expected >= many ? 1 : (expected - few) / (many - few);
    return 1 + t * t * (3 - 2 * t) * (expected / met - 1);
}

}  // namespace parallux
