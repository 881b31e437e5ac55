// SPDX-License-Identifier: Apache-2.0
#include "visibility/gap_faces.h"

#include <glm/geometric.hpp>

#include "base/client.h"
#include "mesh/face_tree.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

// The average number of faces that may be examined for each face. Real meshes need far fewer.
constexpr std::size_t looks_a_face = 100;

class Search {
  public:
    explicit Search(const TetMesh& mesh)
        : mesh_(mesh),
          tree_(mesh, mesh.open_faces()),
          bounds_{mesh.bounds().min, mesh.bounds().max},
          left_(looks_a_face * mesh.open_faces().size()),
          outside_(mesh.points()[static_cast<std::size_t>(mesh.tets()[0][0])]) {}

    std::vector<std::int32_t> find() {
        std::vector<char> outermost(mesh_.open_faces().size());
        std::vector<std::int32_t> found;
        for (std::size_t i = 0; i < outermost.size(); ++i) {
            if (outermost[i]) continue;
            check_interrupt();
            const auto face = static_cast<std::int32_t>(i);
            if (!is_outermost(face)) {
                found.push_back(face);
                continue;
            }
            // One face of a flat side of the mesh is enough.
            for (const std::int32_t other : in_plane_)
                outermost[static_cast<std::size_t>(other)] = true;
        }
        return found;
    }

  private:
    Triangle triangle(std::int32_t face) const {
        return mesh_.corners(mesh_.open_faces()[static_cast<std::size_t>(face)]);
    }

    // If the face is outermost, `in_plane_` has all other faces of its plane.
    bool is_outermost(std::int32_t face) {
        const Triangle corners = triangle(face);
        const RoundedPlane plane(corners[1] - corners[0], corners[2] - corners[0]);
        in_plane_.clear();
        // A point outside of the last face is mostly outside of its neighbours, too.
        if (side_of(corners, plane, outside_) > 0) return false;
        const PlaneSide side(plane, corners[0], bounds_);
        bool outermost = true;
        const auto look_at = [&](std::int32_t other) {
            if (!outermost || other == face) return;
            if (left_ == 0) {
                outermost = false;
                return;
            }
            --left_;
            const Triangle there = triangle(other);
            if (!side.reaches(there)) return;
            bool in_plane = true;
            for (const glm::dvec3& point : there) {
                const int sign = side_of(corners, plane, point);
                in_plane &= sign == 0;
                if (sign <= 0) continue;
                outside_ = point;
                outermost = false;
                return;
            }
            if (!in_plane) return;
            const RoundedPlane touching(there[1] - there[0], there[2] - there[0]);
            if (is_sure(plane) && is_sure(touching) &&
                glm::dot(plane.normal, touching.normal) > 0) {
                in_plane_.push_back(other);
            } else {
                outermost = false;
            }
        };
        tree_.visit([&](const FaceTree::Box& box) { return outermost && side.reaches(box); },
                    look_at);
        return outermost;
    }

    // Returns whether the direction of its normal is certain.
    static bool is_sure(const RoundedPlane& plane) { return norm1(plane.normal) > plane.error; }

    const TetMesh& mesh_;
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::size_t left_;    // looks at faces
    glm::dvec3 outside_;  // a point of the mesh: outside of the last face that is not outermost
    std::vector<std::int32_t> in_plane_;
};

}  // namespace

std::vector<std::int32_t> gap_faces(const TetMesh& mesh) {
    return Search(mesh).find();
}

}  // namespace lamina
