// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <vector>

#include "lamina/clip.h"

namespace lamina {

// The points p of the world with dot(normal, p - point) >= 0. The normal's largest component lies
// between 1 and 2, so that its products do not overflow in any scene.
struct HalfSpace {
    glm::dvec3 point, normal;
};

// Returns the half-spaces whose common part a clip keeps: one for each plane, then six for the box.
// Normals are the clip's own times powers of two, so nothing is rounded. Throws Error if a normal
// is zero or a number is none.
std::vector<HalfSpace> half_spaces(const Clip& clip);

}  // namespace lamina
