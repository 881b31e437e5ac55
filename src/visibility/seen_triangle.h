// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "mesh/eye.h"
#include "mesh/rounded_plane.h"

namespace lamina {

// A triangle as an eye sees it, with the planes through the eye and its edges. The rays through it
// fill a pyramid, or a prism for an eye at infinity.
class SeenTriangle {
  public:
    SeenTriangle() = default;
    SeenTriangle(const Eye& eye, const Triangle& corners);

    // As sign_as_seen (face_signs.h), for a face of a tet: 1 an exit, through which rays leave the
    // tet; -1 an entry; 0 edge-on.
    int sign() const { return sign_; }

    // Of an exit: is a part of `entry`, of positive area as seen from the eye, seen through it and
    // on it or behind it? Exact for triangles that do not cut one another; where they do, true if a
    // part of `entry` lies behind.
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
    std::array<RoundedPlane, 3> edges_;  // of corners 01, 12, 20, through the first of them
    RoundedPlane face_;                  // through corner 0; positive: outside the tet
    int sign_ = 0;
};

// The part of space that is seen through an exit, on it or behind it, to search boxes for.
class SeenThrough {
  public:
    // `bounds`: of all boxes.
    SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds);
    // Never false, whatever the rounding, for a box or a triangle that holds such a point.
    template <typename Shape>
    bool reaches(const Shape& box_or_triangle) const {
        return sides_[0].reaches(box_or_triangle) && sides_[1].reaches(box_or_triangle) &&
               sides_[2].reaches(box_or_triangle) && sides_[3].reaches(box_or_triangle);
    }

  private:
    std::array<PlaneSide, 4> sides_;
};

}  // namespace lamina
