// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>

#include "mesh/predicates.h"

namespace lamina {

// A number that grows with the distance of a point from the eye, for comparisons: the squared
// distance, or for an eye at infinity the distance along the view.
inline double view_distance(const Eye& eye, const glm::dvec3& point) {
    if (eye.at_infinity) return glm::dot(eye.position, point);
    const glm::dvec3 ray = point - eye.position;
    return glm::dot(ray, ray);
}

}  // namespace lamina
