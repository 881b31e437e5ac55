// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "mesh/face_tree.h"

namespace lamina {

using Triangle = std::array<glm::dvec3, 3>;

// A plane through a given point, with a bound on its rounding error.
struct RoundedPlane {
    RoundedPlane() = default;
    RoundedPlane(const glm::dvec3& u, const glm::dvec3& v);  // spanned by these two vectors

    glm::dvec3 normal{0};
    double error = 0;  // error of its value at a point, per unit (1-norm) of distance
    // The sign (1 or -1) of the true plane's value, or 0 where rounding leaves it unknown.
    int sign(const glm::dvec3& from_origin) const;
};

// The exact side of a triangle's plane on which a point lies: 1 where the corners are seen
// counter-clockwise from it, -1 on the other side, 0 on the plane. `plane`: the plane through the
// first corner along the edges from there.
int side_of(const Triangle& face, const RoundedPlane& plane, const glm::dvec3& point);

// The half space on the positive side of a plane, with the plane. Boxes are searched for what it
// may contain.
class PlaneSide {
  public:
    PlaneSide() = default;
    // `bounds`: a box around all boxes.
    PlaneSide(const RoundedPlane& plane, const glm::dvec3& origin, const FaceTree::Box& bounds);
    // Whether a box or a triangle may contain a point of the half space. Rounding never makes this
    // false where it does contain one.
    bool reaches(const FaceTree::Box& box) const {
        // The corner of the box that is farthest along the normal.
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
