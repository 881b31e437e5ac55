// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include "mesh/tet_mesh.h"

namespace lamina {

// A tree of boxes around faces of a mesh, to find those that a ray or another shape may meet.
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
    // Returns the empty box, to which others can be added.
    static constexpr Box nothing() { return {glm::dvec3(INFINITY), glm::dvec3(-INFINITY)}; }

    static Box box_around(std::span<const glm::dvec3> corners) {
        Box box = nothing();
        for (const glm::dvec3& corner : corners) box.add(corner);
        return box;
    }

    FaceTree(const TetMesh& mesh, std::span<const TetFace> faces);
    // Makes a tree of other things than faces, by their boxes. Parallel.
    explicit FaceTree(std::span<const Box> boxes);

    // Calls visit(face index) for the faces of each leaf if meets(box) holds in it and all nodes
    // above.
    template <typename Meets, typename Visit>
    void visit(const Meets& meets, const Visit& visit) const {
        visit_nodes([&](std::size_t node) { return meets(nodes_[node].box); }, visit);
    }

    // Does what visit() does, but calls meets() with the node's number instead of its box.
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
                for (std::int32_t i = node.first; i < node.end; ++i) visit(order_[i]);
            }
        }
    }

    std::size_t node_count() const { return nodes_.size(); }

    // Fills `nodes`, one entry a node, with sums over the faces below each: add_face(index, entry)
    // adds a face to a leaf's entry, Known::add() an entry to another. `nothing`: the empty sum.
    template <typename Known, typename AddFace>
    void sum(std::span<Known> nodes, const Known& nothing, const AddFace& add_face) const {
        for (std::size_t i = nodes_.size(); i-- > 0;) {  // children before their parents
            const Node& node = nodes_[i];
            nodes[i] = nothing;
            if (node.right >= 0) {
                nodes[i].add(nodes[i + 1]);
                nodes[i].add(nodes[node.right]);
                continue;
            }
            for (std::int32_t at = node.first; at < node.end; ++at) add_face(order_[at], nodes[i]);
        }
    }

  private:
    struct Node {
        Box box;
        std::int32_t first, end;  // range in order_
        std::int32_t right;  // right child, or -1 for a leaf; the left child follows its parent
    };
    void build(std::span<const Box> boxes, std::size_t self, std::int32_t first, std::int32_t end);

    std::vector<Node> nodes_;
    std::vector<std::int32_t> order_;
};

using Triangle = std::array<glm::dvec3, 3>;

// The plane through an origin that two vectors span; its normal is rounded.
struct RoundedPlane {
    RoundedPlane() = default;
    RoundedPlane(const glm::dvec3& u, const glm::dvec3& v);

    glm::dvec3 normal{0};
    double error = 0;  // error of dot(normal, point - origin), per unit (1-norm) of distance
    // Returns the exact side, 1 or -1, of origin + from_origin; 0 if rounding leaves it unknown.
    int sign(const glm::dvec3& from_origin) const;
};

// Returns the exact side of a triangle's plane on which a point lies: 1 if the corners are seen
// counter-clockwise from it. `plane` goes through the first corner.
int side_of(const Triangle& face, const RoundedPlane& plane, const glm::dvec3& point);

// The closed half space on the positive side of a plane.
class PlaneSide {
  public:
    PlaneSide() = default;
    // `bounds`: a box around all shapes that reaches() is called with.
    PlaneSide(const RoundedPlane& plane, const glm::dvec3& origin, const FaceTree::Box& bounds);
    // Tells whether a shape may contain a point of the half space. Rounding never makes it false.
    bool reaches(const FaceTree::Box& box) const {
        const auto most = [&](int axis) {
            return normal_[axis] * (normal_[axis] > 0 ? box.max[axis] : box.min[axis]);
        };
        return most(0) + most(1) + most(2) >= limit_;
    }
    bool reaches(const Triangle& triangle) const {
        return at(triangle[0]) >= limit_ || at(triangle[1]) >= limit_ || at(triangle[2]) >= limit_;
    }

  private:
    double at(const glm::dvec3& point) const { return glm::dot(normal_, point); }

    glm::dvec3 normal_{0};
    double limit_ = 0;
};

}  // namespace lamina
