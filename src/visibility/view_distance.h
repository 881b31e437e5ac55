// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>

#include "mesh/eye.h"

namespace lamina {

// Grows with the distance of a point from the eye: its square, or the distance along the view for
// an eye at infinity. To compare points with.
inline double view_distance(const Eye& eye, const glm::dvec3& point) {
    if (eye.at_infinity) return glm::dot(eye.position, point);
    const glm::dvec3 ray = point - eye.position;
    return glm::dot(ray, ray);
}

}  // namespace lamina
