// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "visibility/seen_shapes.h"

namespace lamina {

// Finds the open faces at which gaps of a mesh may begin or end as seen from some eye. Returns
// indices into TetMesh::open_faces() in ascending order. A face is left out if no other part of the
// mesh lies outside of it or touches it from there: a ray that leaves the mesh through such a face
// does not come back, and a ray that enters by it has not met the mesh before. The result is exact,
// unless that would take too long, as it does on finely faceted surfaces that are flat up to
// rounding: then it contains some other faces, too.
std::vector<std::int32_t> gap_faces(const TetMesh& mesh);

// A pair of open faces, by indices into TetMesh::open_faces(): some ray leaves the mesh through
// `exit` and comes back later through `entry`. So the tet of the exit is nearer than that of the
// entry.
struct OpenFaceConstraint {
    std::int32_t exit, entry;
};

// Finds, for one eye after the other, the constraints that the gaps of a nonconvex mesh add to its
// order: all pairs of an exit and an entry behind it that overlap as seen from the eye. Each
// constraint holds along some ray, and every ray from one part of the mesh to the next meets one.
// With the order across shared faces they are therefore all that an order must keep. Silva,
// Mitchell and Williams (1998) and Comba et al. (1999, XMPVO) find them by sweeping over the
// projected boundary. Here every exit asks a tree of boxes for the entries that are seen through
// it. This works for any eye, inside the mesh and at infinity too, and needs no order from face to
// face. Faces at which no gap can end (gap_faces()) are left out once and for all. The mesh must
// outlive this object.
class OpenFaceConstraints {
  public:
    explicit OpenFaceConstraints(const TetMesh& mesh);

    // Returns the constraints for an eye. Their order depends only on the mesh and the eye.
    // Parallel. Memory grows only for views with more pairs than any view before.
    std::span<const OpenFaceConstraint> find(const Eye& eye);

  private:
    // Bounds in world space, and as seen from the eye (SeenBoxes).
    struct Boxes {
        FaceTree::Box world, seen;
        void add(const Boxes& other) {
            world.add(other.world);
            seen.add(other.seen);
        }
    };
    OpenFaceConstraints(const TetMesh& mesh, std::vector<std::int32_t> gap_faces);
    void look_from(const Eye& eye);
    // Returns the number of faces that were tested.
    std::size_t find_from(std::size_t exit, const Eye& eye,
                          std::vector<OpenFaceConstraint>& found) const;

    const TetMesh& mesh_;
    // Faces at which gaps may end; the following members are about these.
    std::vector<std::int32_t> open_faces_;
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::vector<Triangle> triangles_;
    std::vector<Boxes> boxes_;  // boxes of the entries below each node of the tree
    std::vector<FaceTree::Box> seen_boxes_;
    std::vector<SeenTriangle> seen_;
    std::vector<std::int8_t> signs_;                      // signs of seen_, packed
    std::vector<std::vector<OpenFaceConstraint>> found_;  // result of each run of faces
    std::vector<OpenFaceConstraint> all_;
};

}  // namespace lamina
