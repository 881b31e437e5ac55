// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/eye.h"
#include "mesh/face_tree.h"
#include "visibility/seen_triangle.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Rays leave the mesh through open face `exit` and come back, later, through open face `entry`: the
// tet of the exit is nearer than that of the entry. Both index TetMesh::open_faces().
struct OpenFaceConstraint {
    std::int32_t exit, entry;
};

// Finds, for one eye after the other, what the gaps of a nonconvex mesh add to its order: all pairs
// of an exit and of an entry behind it that overlap as seen from the eye. Each is true along some
// ray, and every ray from one part of the mesh to the next meets one: with the order across shared
// faces they are all that an order has to keep. Silva, Mitchell and Williams (1998) and Comba et
// al. (1999, XMPVO) find them by sweeping over the projected boundary; here every exit asks a tree
// of boxes for what is seen through it, which holds for any eye, inside and at infinity too, and
// needs no order from face to face. Faces at which no gap can end (gap_faces.h) are left out for
// good. The mesh must outlive this object.
class OpenFaceConstraints {
  public:
    explicit OpenFaceConstraints(const TetMesh& mesh);

    // In an order that depends on the mesh and the eye alone. Parallel; its memory grows only for
    // views with more pairs than any before.
    std::span<const OpenFaceConstraint> find(const Eye& eye);

  private:
    // In the world, and as seen (seen_box.h).
    struct Boxes {
        FaceTree::Box world, seen;
        void add(const Boxes& other) {
            world.add(other.world);
            seen.add(other.seen);
        }
    };
    OpenFaceConstraints(const TetMesh& mesh, std::vector<std::int32_t> gap_faces);
    void look_from(const Eye& eye);
    // The number of faces looked at.
    std::size_t find_from(std::size_t exit, const Eye& eye,
                          std::vector<OpenFaceConstraint>& found) const;

    const TetMesh& mesh_;
    std::vector<std::int32_t> open_faces_;  // at which gaps may end; what follows is about these
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::vector<Triangle> triangles_;
    std::vector<Boxes> boxes_;  // of the entries below each node of the tree
    std::vector<FaceTree::Box> seen_boxes_;
    std::vector<SeenTriangle> seen_;
    std::vector<std::int8_t> signs_;                      // of seen_, close together
    std::vector<std::vector<OpenFaceConstraint>> found_;  // of each run of faces
    std::vector<OpenFaceConstraint> all_;
};

}  // namespace lamina
