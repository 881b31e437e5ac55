// SPDX-License-Identifier: Apache-2.0
#include "mesh/face_tree.h"

#include <numeric>

#include "base/parallel.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

constexpr std::int32_t faces_per_leaf = 4;

// Smallest number of faces whose two halves are built on two cores: some .2 ms of work.
constexpr std::int32_t faces_of_two_tasks = 2048;

constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

// Returns the numbers of nodes of trees of `faces` and of `faces + 1` faces, whose halves, rounded
// down and up, are trees of as many faces as those of `faces / 2` and of one more.
std::array<std::size_t, 2> nodes_of(std::int32_t faces) {
    if (faces < faces_per_leaf) return {1, 1};
    const auto [lower, upper] = nodes_of(faces / 2);
    if (faces == faces_per_leaf) return {1, 1 + lower + upper};
    if (faces % 2 == 0) return {1 + 2 * lower, 1 + lower + upper};
    return {1 + lower + upper, 1 + 2 * upper};
}

std::vector<FaceTree::Box> boxes_of(const TetMesh& mesh, std::span<const TetFace> faces) {
    std::vector<FaceTree::Box> boxes;
    boxes.reserve(faces.size());
    for (const TetFace& face : faces) boxes.push_back(FaceTree::box_around(mesh.corners(face)));
    return boxes;
}

}  // namespace

FaceTree::FaceTree(const TetMesh& mesh, std::span<const TetFace> faces)
    : FaceTree(boxes_of(mesh, faces)) {}

FaceTree::FaceTree(std::span<const Box> boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0);
    const auto count = static_cast<std::int32_t>(boxes.size());
    nodes_.resize(nodes_of(count)[0]);
    build(boxes, 0, 0, count);
}

// Splits at the median of the boxes' centers, along the axis on which these extend most.
void FaceTree::build(std::span<const Box> boxes, std::size_t self, std::int32_t first,
                     std::int32_t end) {
    Box box = nothing(), centers = box;
    for (std::int32_t i = first; i < end; ++i) {
        const Box& face = boxes[order_[i]];
        box.add(face);
        centers.add(0.5 * face.min + 0.5 * face.max);
    }
    nodes_[self] = {box, first, end, -1};
    if (end - first <= faces_per_leaf) return;
    const glm::dvec3 extent = centers.max - centers.min;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::int32_t middle = first + (end - first) / 2;
    const auto center = [&](std::int32_t face) {
        const Box& b = boxes[face];
        return 0.5 * b.min[axis] + 0.5 * b.max[axis];
    };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::int32_t a, std::int32_t b) { return center(a) < center(b); });
    const std::size_t left = self + 1, right = left + nodes_of(middle - first)[0];
    nodes_[self].right = static_cast<std::int32_t>(right);
    const auto build_left = [&] { build(boxes, left, first, middle); };
    const auto build_right = [&] { build(boxes, right, middle, end); };
    if (end - first < faces_of_two_tasks) {
        build_left();
        build_right();
    } else {
        parallel_invoke(build_left, build_right);
    }
}

// The error: a cross product of rounded differences is off by at most 3 epsilon |u| |v| (1-norms),
// its product with p by as much again and 3 epsilon of itself: together < 16 epsilon |u| |v| |p|.
RoundedPlane::RoundedPlane(const glm::dvec3& u, const glm::dvec3& v)
    : normal(glm::cross(u, v)), error(16 * machine_epsilon * norm1(u) * norm1(v)) {}

int RoundedPlane::sign(const glm::dvec3& from_origin) const {
    const double value = glm::dot(normal, from_origin), bound = error * norm1(from_origin);
    return value > bound ? 1 : -value > bound ? -1 : 0;
}

int side_of(const Triangle& face, const RoundedPlane& plane, const glm::dvec3& point) {
    if (const int sign = plane.sign(point - face[0])) return sign;
    if (point == face[0] || point == face[1] || point == face[2]) return 0;
    return orientation(face[0], face[1], face[2], point);
}

// The limit is lowered by the error of dot(normal, point - origin) at the largest distance in the
// box, and by 8 roundings of the products of the normal with coordinates.
PlaneSide::PlaneSide(const RoundedPlane& plane, const glm::dvec3& origin,
                     const FaceTree::Box& bounds)
    : normal_(plane.normal) {
    const double extent = norm1(bounds.max - bounds.min);
    const double coordinate = std::max(norm1(bounds.min), norm1(bounds.max));
    limit_ = glm::dot(normal_, origin) - plane.error * extent -
             8 * machine_epsilon * norm1(normal_) * coordinate;
}

}  // namespace lamina
