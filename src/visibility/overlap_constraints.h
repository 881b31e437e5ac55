// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/tet_overlaps.h"
#include "visibility/open_face_constraints.h"

namespace lamina {

// Finds the constraints that overlapping tets add to those of shared faces and of gaps, so that an
// order that keeps all that a ray sees draws the ray's tets by entry (EntryRule). A ray enters tet
// T right after tet S. Then either they overlap, or S ends before T begins. If so, S ends at an
// open face, or the ray would enter S's neighbour in between; T begins at an open face, which is
// then seen across a gap, or at a face that it shares with a tet P, which the ray entered before S,
// so that S and P overlap. Hence for each pair of overlapping tets:
//   1. the tet that a ray enters first is nearer: its front face is before the other's;
//   2. one of them, if the ray leaves it by an open face before it leaves the other one by a shared
//      face, is nearer than the other one's neighbour there;
//   3. if the ray enters both at one place, the tet that it left there for one of them is nearer
//      than the other one: S may end at a shared face where T begins, and T come before S's
//      neighbour by its number.
// A tet around the eye is entered at the eye. Tets whose front faces lie in one plane are ordered
// by their numbers.
class OverlapConstraints {
  public:
    // `pairs`: all TetOverlaps::pairs of the mesh, which must outlive this object.
    OverlapConstraints(const TetMesh& mesh, std::span<const TetPair> pairs);

    // Returns the open faces of the mesh and, after them, faces of overlapping tets: constraints
    // are pairs of their indices.
    std::span<const TetFace> faces() const { return faces_; }
    // Returns the constraints for an eye until the next call, in an order set by mesh and eye.
    // Their exit may be a front face, which then counts as seen from inside the tet. Parallel.
    std::span<const OpenFaceConstraint> find(const Eye& eye);

  private:
    // A tet as the eye sees it. `fronts`: its front faces, turned into exits.
    struct SeenTet {
        std::array<SeenTriangle, 4> faces, fronts;
        bool around_eye = true;  // no ray from the eye enters it
    };
    // Constraints of one pair that find() collects.
    using Found = std::vector<OpenFaceConstraint>;

    std::int32_t face_index(std::int32_t tet, std::size_t face) const {
        return first_face_[tet] + static_cast<std::int32_t>(face);
    }
    const SeenTet& seen(std::int32_t tet) const {
        return seen_[(first_face_[tet] - open_faces_) / 4];
    }
    void look_from(const Eye& eye);
    void order_fronts(const Eye& eye, double tie, const TetPair& pair, Found& found) const;
    void order_front(const Eye& eye, double tie, std::int32_t a, std::size_t of_a, std::int32_t b,
                     std::size_t of_b, Found& found) const;
    void order_before(std::int32_t tet, std::size_t front, std::int32_t entry, Found& found) const;
    void order_behind(const Eye& eye, std::int32_t inner, std::int32_t outer, Found& found) const;

    const TetMesh& mesh_;
    std::vector<TetPair> pairs_;
    std::int32_t open_faces_;
    std::vector<TetFace> faces_;
    std::vector<std::int32_t> first_face_;  // of each tet, in faces_; -1 if it has none there
    std::vector<SeenTet> seen_;
    std::vector<Found> found_;  // what each task of find() found
    Found all_;
};

}  // namespace lamina
