// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>

#include "mesh/eye.h"
#include "mesh/face_tree.h"
#include "mesh/rounded_plane.h"

namespace lamina {

// Boxes around triangles as an eye sees them, in two coordinates across rays that are the same
// along each, and a third that grows along them: where boxes are apart, so are the triangles. For
// one side of the eye; triangles that are not well on that side have the box of everything.
class SeenBoxes {
  public:
    // Towards `center`.
    SeenBoxes(const Eye& eye, const glm::dvec3& center);

    FaceTree::Box of(const Triangle& triangle) const;

  private:
    bool at_infinity_;
    glm::dvec3 origin_;
    glm::dmat3 axes_;  // columns: across, across, along the rays
};

// May some ray meet what is in `exit`, and then, or there, what is in `entry`?
inline bool may_show(const FaceTree::Box& exit, const FaceTree::Box& entry) {
    return entry.max.x >= exit.min.x && entry.min.x <= exit.max.x && entry.max.y >= exit.min.y &&
           entry.min.y <= exit.max.y && entry.max.z >= exit.min.z;
}

}  // namespace lamina
