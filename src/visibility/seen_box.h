// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>

#include "mesh/face_tree.h"
#include "mesh/predicates.h"

namespace lamina {

// Boxes around triangles as an eye sees them. Two coordinates run across the rays and are constant
// along each ray; the third grows along the rays. Where two boxes are disjoint, so are the
// triangles. The boxes hold for one side of the eye. A triangle that is not well on that side has a
// box that contains everything.
class SeenBoxes {
  public:
    // For the side of the eye towards `center`.
    SeenBoxes(const Eye& eye, const glm::dvec3& center);

    FaceTree::Box of(const Triangle& triangle) const;

  private:
    bool at_infinity_;
    glm::dvec3 origin_;
    glm::dmat3 axes_;  // columns: two across the rays, one along them
};

// Whether some ray may meet a triangle in `exit` and then, or at the same point, one in `entry`.
inline bool may_show(const FaceTree::Box& exit, const FaceTree::Box& entry) {
    return entry.max.x >= exit.min.x && entry.min.x <= exit.max.x && entry.max.y >= exit.min.y &&
           entry.min.y <= exit.max.y && entry.max.z >= exit.min.z;
}

}  // namespace lamina
