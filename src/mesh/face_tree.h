// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace lamina {

// A hierarchy of boxes around faces of a mesh, usually its open faces. It finds the faces that a
// ray, a pyramid or another shape may meet.
class FaceTree {
  public:
    struct Box {
        glm::dvec3 min, max;
        void add(const glm::dvec3& point) { add({point, point}); }
        void add(const Box& other) {
            min = glm::min(min, other.min);
            max = glm::max(max, other.max);
        }
    };
    static constexpr Box nothing() { return {glm::dvec3(INFINITY), glm::dvec3(-INFINITY)}; }

    static Box box_around(const std::array<glm::dvec3, 3>& corners) {
        Box box = nothing();
        for (const glm::dvec3& corner : corners) box.add(corner);
        return box;
    }

    FaceTree(const TetMesh& mesh, std::span<const TetFace> faces);

    // Calls visit(index into the faces) for all faces below the boxes for which meets(box) holds.
    template <typename Meets, typename Visit>
    void visit(const Meets& meets, const Visit& visit) const {
        visit_nodes([&](std::size_t node) { return meets(nodes_[node].box); }, visit);
    }

    // The same, but the test gets the number of the node: meets(number of the node).
    template <typename Meets, typename Visit>
    void visit_nodes(const Meets& meets, const Visit& visit) const {
        std::array<std::int32_t, 64> stack;  // the tree is balanced: its height is below 32
        std::size_t waiting = 0;
        if (!nodes_.empty()) stack[waiting++] = 0;
        while (waiting > 0) {
            const auto number = static_cast<std::size_t>(stack[--waiting]);
            if (!meets(number)) continue;
            const Node& node = nodes_[number];
            if (node.right >= 0) {
                stack[waiting++] = node.right;
                stack[waiting++] = static_cast<std::int32_t>(number) + 1;
            } else {
                for (std::int32_t i = node.first; i < node.end; ++i)
                    visit(order_[static_cast<std::size_t>(i)]);
            }
        }
    }

    std::size_t node_count() const { return nodes_.size(); }

    // Sums up what add_face(index, node) adds for the faces below each node. `nodes` has one
    // element a node; all start from `nothing` and are combined by add().
    template <typename Known, typename AddFace>
    void sum(std::span<Known> nodes, const Known& nothing, const AddFace& add_face) const {
        for (std::size_t i = nodes_.size(); i-- > 0;) {  // children before their parents
            const Node& node = nodes_[i];
            nodes[i] = nothing;
            if (node.right >= 0) {
                nodes[i].add(nodes[i + 1]);
                nodes[i].add(nodes[static_cast<std::size_t>(node.right)]);
                continue;
            }
            for (std::int32_t at = node.first; at < node.end; ++at)
                add_face(order_[static_cast<std::size_t>(at)], nodes[i]);
        }
    }

  private:
    struct Node {
        Box box;
        std::int32_t first, end;  // range in order_
        std::int32_t right;  // right child, or -1 for a leaf; the left child follows its parent
    };
    void build(std::span<const Box> boxes, std::int32_t first, std::int32_t end);

    std::vector<Node> nodes_;
    std::vector<std::int32_t> order_;
};

}  // namespace lamina
