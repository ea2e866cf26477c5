#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace parallux {

struct TreePoint {
    glm::dvec3 place{0};
    double reach = 0;
    std::uint32_t id = 0;
};

/// Points of very different reach, halved along the longest side of their bounds.
class PointTree {
public:
    explicit PointTree(std::vector<TreePoint> points) : points_(std::move(points)) {
        if (!points_.empty())
            build(0, static_cast<std::uint32_t>(points_.size()));
    }

    /// Calls found(id) for every point nearer than the larger of its reach and the given one.
    template <typename Found>
    void visit(const glm::dvec3& place, double reach, Found&& found) const {
        std::uint32_t stack[64];
        int depth = 0;
        if (!nodes_.empty())
            stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            glm::dvec3 nearest = glm::clamp(place, node.low, node.high);
            if (glm::distance(nearest, place) >= std::max(reach, node.reach))
                continue;
            if (node.right == 0) {
                for (std::uint32_t i = node.begin; i < node.end; ++i)
                    if (glm::distance(points_[i].place, place) < std::max(reach, points_[i].reach))
                        found(points_[i].id);
            } else {
                stack[depth++] = node.right;
                stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
            }
        }
    }

private:
    static constexpr std::uint32_t leaf = 8;

    struct Node {
        glm::dvec3 low, high;
        double reach;
        std::uint32_t begin, end;
        std::uint32_t right;  // 0: a leaf; the left child follows its parent
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
        Node node{points_[begin].place, points_[begin].place, 0, begin, end, 0};
        for (std::uint32_t i = begin; i < end; ++i) {
            node.low = glm::min(node.low, points_[i].place);
            node.high = glm::max(node.high, points_[i].place);
            node.reach = std::max(node.reach, points_[i].reach);
        }
        std::uint32_t index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(node);
        if (end - begin <= leaf)
            return index;
        glm::dvec3 side = node.high - node.low;
        int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
        std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                         [axis](const TreePoint& a, const TreePoint& b) {
                             return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis]
                                                                   : a.id < b.id;
                         });
        build(begin, middle);
        std::uint32_t right = build(middle, end);
        nodes_[index].right = right;
        return index;
    }

    std::vector<TreePoint> points_;
    std::vector<Node> nodes_;
};

}  // namespace parallux
