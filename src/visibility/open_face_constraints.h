// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "mesh/face_tree.h"
#include "mesh/few_points.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// A triangle cut by up to four planes, each of which adds at most one corner.
using CutTriangle = FewPoints<glm::dvec3, 7>;

// Returns the part of an entry that is behind an exit's plane, or less than `slack` in front of it.
CutTriangle part_behind(const CutTriangle& exit, const CutTriangle& entry, double slack);

// A triangle as an eye sees it. The rays through it fill a pyramid, or a prism.
class SeenTriangle {
  public:
    SeenTriangle() = default;
    SeenTriangle(const Eye& eye, const Triangle& corners);

    // Returns 1 if rays leave the tet by this face (an exit), -1 if they enter, 0 if edge-on.
    int sign() const { return sign_; }

    // Tells whether `entry`, behind or on this exit, is seen through it with an area > 0. If the
    // triangles intersect, only the part of `entry` behind the exit counts.
    bool shows(const Eye& eye, const SeenTriangle& entry) const;

  private:
    friend class SeenThrough;
    int edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const;
    int all_on_one_side(const SeenTriangle& other) const;
    bool sees_ahead(const Eye& eye, const SeenTriangle& other) const;
    bool separated_by_edge(const Eye& eye, const SeenTriangle& other) const;
    bool apart(const Eye& eye, const SeenTriangle& entry) const;
    bool overlap_is_behind(const Eye& eye, const SeenTriangle& entry) const;

    Triangle corners_{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
    // Planes of edges 01, 12, 20, through the first corner of each.
    std::array<RoundedPlane, 3> edges_;
    RoundedPlane face_;  // plane of the triangle, through corner 0; positive outside the tet
    int sign_ = 0;
};

// The region that is seen through an exit, on it or behind it: a test for searches in a FaceTree.
class SeenThrough {
  public:
    // `bounds`: a box around all shapes that reaches() is called with.
    SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds);
    // Tells whether a shape may contain a point of the region. Rounding never makes this false.
    template <typename Shape>
    bool reaches(const Shape& box_or_triangle) const {
        return sides_[0].reaches(box_or_triangle) && sides_[1].reaches(box_or_triangle) &&
               sides_[2].reaches(box_or_triangle) && sides_[3].reaches(box_or_triangle);
    }

  private:
    std::array<PlaneSide, 4> sides_;
};

// Returns a triangle's solid angle (steradian), or for an eye at infinity its projected area.
double seen_area(const Eye& eye, const Triangle& triangle);

// Returns the seen area of `entry` through `exit`, whose corners are clockwise for the eye. Parts
// of `entry` that are more than `in_front` in front of the exit's plane do not count.
double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry,
                    double in_front = INFINITY);

// Returns the indices, ascending, of open faces where gaps may begin or end: another part of the
// mesh lies outside of their plane, or touches it from outside. It may return more faces if finely
// faceted surfaces are flat up to rounding: deciding would take too long.
std::vector<std::int32_t> gap_faces(const TetMesh& mesh);

// Two open faces, by index: some ray leaves a tet by `exit`, then enters a farther one by `entry`.
struct OpenFaceConstraint {
    std::int32_t exit, entry;
};

// Finds all pairs of an exit and an entry behind it that overlap as seen from the eye; a visibility
// order must keep these and the order across shared faces. Silva, Mitchell, Williams (1998) and
// Comba et al. (1999, XMPVO) sweep over the projected boundary; here each exit searches a tree.
class OpenFaceConstraints {
  public:
    explicit OpenFaceConstraints(const TetMesh& mesh);

    // Returns the pairs for an eye until the next call, in an order set by mesh and eye. Parallel.
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
    void look_from(const Eye& eye);
    std::size_t find_from(std::size_t exit, const Eye& eye,
                          std::vector<OpenFaceConstraint>& found) const;

    const TetMesh& mesh_;
    // Result of gap_faces(). Members below have an entry for each of these faces, or each node.
    std::vector<std::int32_t> open_faces_;
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::vector<Triangle> triangles_;
    std::vector<Boxes> boxes_;  // boxes of the entries below each node of the tree
    std::vector<FaceTree::Box> seen_boxes_;
    std::vector<SeenTriangle> seen_;
    std::vector<std::int8_t> signs_;                      // signs of seen_, packed
    std::vector<std::vector<OpenFaceConstraint>> found_;  // pairs that each task of find() found
    std::vector<OpenFaceConstraint> all_;
};

}  // namespace lamina
