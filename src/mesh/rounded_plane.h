// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "mesh/face_tree.h"

namespace lamina {

using Triangle = std::array<glm::dvec3, 3>;

// A plane through a given point, off by rounding.
struct RoundedPlane {
    RoundedPlane() = default;
    RoundedPlane(const glm::dvec3& u, const glm::dvec3& v);  // along these two

    glm::dvec3 normal{0};
    double error = 0;  // of its value at a point, for each unit (1-norm) of distance
    // 1 or -1 where that is the sign of the true plane's value; 0: not known.
    int sign(const glm::dvec3& from_origin) const;
};

// On which side of a triangle's plane a point is, exactly: 1 where its corners are seen
// counter-clockwise, -1, or 0. `plane`: through its first corner along the edges from there.
int side_of(const Triangle& face, const RoundedPlane& plane, const glm::dvec3& point);

// What is on the positive side of a plane or on it, to search boxes for.
class PlaneSide {
  public:
    PlaneSide() = default;
    // `bounds`: of all boxes.
    PlaneSide(const RoundedPlane& plane, const glm::dvec3& origin, const FaceTree::Box& bounds);
    // Never false, whatever the rounding, for a box or a triangle with a point there.
    bool reaches(const FaceTree::Box& box) const {
        // Its corner farthest along the normal.
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
