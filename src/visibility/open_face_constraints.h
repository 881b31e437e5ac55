// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Keeps the part of a convex polygon with height(corner) >= 0, a linear function (Sutherland and
// Hodgman, Reentrant polygon clipping, 1974).
template <typename Polygon, typename Height>
Polygon cut(const Polygon& polygon, const Height& height) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const auto& a = polygon.corners[i];
        const auto& b = polygon.corners[(i + 1) % polygon.count];
        const double at_a = height(a), at_b = height(b);
        if (at_a >= 0) kept.add(a);
        if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
            kept.add(a + (at_a / (at_a - at_b)) * (b - a));
    }
    return kept;
}

// A triangle as an eye sees it. The rays through it fill a pyramid, or a prism.
class SeenTriangle {
  public:
    SeenTriangle() = default;
    SeenTriangle(const Eye& eye, const Triangle& corners);

    // As sign_as_seen(). 1: an exit of its tet. -1: an entry. 0: seen edge-on.
    int sign() const { return sign_; }

    // Tells whether some of `entry`, of positive seen area, is seen through this exit, on it or
    // behind it. Triangles that intersect: true if some of `entry` lies behind the exit.
    bool shows(const Eye& eye, const SeenTriangle& entry) const;

  private:
    friend class SeenThrough;
    int edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const;
    int all_on_one_side(const SeenTriangle& other) const;
    bool sees_ahead(const Eye& eye, const SeenTriangle& other) const;
    bool separated_by_edge(const Eye& eye, const SeenTriangle& other) const;
    bool apart(const Eye& eye, const SeenTriangle& entry) const;
    bool behind_where_mixed(const Eye& eye, const SeenTriangle& entry) const;

    Triangle corners_{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
    // Planes of edges 01, 12, 20, through the first corner of each.
    std::array<RoundedPlane, 3> edges_;
    RoundedPlane face_;  // plane of the triangle through corner 0; positive outside the tet
    int sign_ = 0;
};

// The region that is seen through an exit, on it or behind it, for searches in boxes.
class SeenThrough {
  public:
    // `bounds`: a box around all boxes.
    SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds);
    // Rounding never makes this false for a shape with a point of the region.
    template <typename Shape>
    bool reaches(const Shape& box_or_triangle) const {
        return sides_[0].reaches(box_or_triangle) && sides_[1].reaches(box_or_triangle) &&
               sides_[2].reaches(box_or_triangle) && sides_[3].reaches(box_or_triangle);
    }

  private:
    std::array<PlaneSide, 4> sides_;
};

// Solid angle (steradian), or for an eye at infinity projected area (world units squared).
double seen_area(const Eye& eye, const Triangle& triangle);

// Seen area of `entry` through `exit` (corners clockwise for the eye).
double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry);

// Finds the open faces (ascending indices) at which gaps may begin or end: outside of them lies
// another part of the mesh, or touches them. Finely faceted surfaces that are flat up to rounding
// may have others, too, which saves time.
std::vector<std::int32_t> gap_faces(const TetMesh& mesh);

// A pair of open faces, by index: some ray leaves the mesh through `exit` and comes back through
// `entry`, so the tet of the exit is nearer.
struct OpenFaceConstraint {
    std::int32_t exit, entry;
};

// Finds all pairs of an exit and an entry behind it that overlap as seen from the eye: with the
// order across shared faces all that an order must keep. Silva, Mitchell and Williams (1998) and
// Comba et al. (1999, XMPVO) sweep over the projected boundary; here every exit asks a tree of
// boxes, for any eye. The mesh must outlive this object.
class OpenFaceConstraints {
  public:
    explicit OpenFaceConstraints(const TetMesh& mesh);

    // The order depends only on the mesh and the eye. Parallel. Memory is kept.
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
