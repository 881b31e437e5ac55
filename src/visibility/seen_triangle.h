// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "mesh/face_tree.h"
#include "mesh/predicates.h"

namespace lamina {

// A triangle as an eye sees it, with the planes through the eye and its edges. The rays through the
// triangle fill a pyramid, or a prism for an eye at infinity.
class SeenTriangle {
  public:
    SeenTriangle() = default;
    SeenTriangle(const Eye& eye, const Triangle& corners);

    // The sign that sign_as_seen (face_signs.h) gives for a face of a tet. 1: an exit, through
    // which rays leave the tet. -1: an entry. 0: seen edge-on.
    int sign() const { return sign_; }

    // For an exit: whether some of `entry`, of positive seen area, is seen through the exit, on it
    // or behind it. Exact for triangles that do not intersect. For others it is true if some of
    // `entry` lies behind the exit.
    bool shows(const Eye& eye, const SeenTriangle& entry) const;

  private:
    friend class SeenThrough;
    int edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const;
    int face_sign(const glm::dvec3& point) const;
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

// The region of space that is seen through an exit, on it or behind it. Boxes are searched for what
// it may contain.
class SeenThrough {
  public:
    // `bounds`: a box around all boxes.
    SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds);
    // Whether a box or a triangle may contain a point of the region. Rounding never makes this
    // false where it does contain one.
    template <typename Shape>
    bool reaches(const Shape& box_or_triangle) const {
        return sides_[0].reaches(box_or_triangle) && sides_[1].reaches(box_or_triangle) &&
               sides_[2].reaches(box_or_triangle) && sides_[3].reaches(box_or_triangle);
    }

  private:
    std::array<PlaneSide, 4> sides_;
};

}  // namespace lamina
