// SPDX-License-Identifier: Apache-2.0
#include "mesh/rounded_plane.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/norm1.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

// A cross product of two rounded differences is off by at most 3 epsilon |u| |v| (1-norms) in each
// component, and its product with a third difference p by as much again and 3 epsilon of itself:
// less than 16 epsilon |u| |v| |p| in all.
RoundedPlane::RoundedPlane(const glm::dvec3& u, const glm::dvec3& v)
    : normal(glm::cross(u, v)), error(16 * epsilon * norm1(u) * norm1(v)) {}

int RoundedPlane::sign(const glm::dvec3& from_origin) const {
    const double value = glm::dot(normal, from_origin), bound = error * norm1(from_origin);
    return value > bound ? 1 : -value > bound ? -1 : 0;
}

int side_of(const Triangle& face, const RoundedPlane& plane, const glm::dvec3& point) {
    if (const int sign = plane.sign(point - face[0])) return sign;
    if (point == face[0] || point == face[1] || point == face[2]) return 0;
    return orientation(face[0], face[1], face[2], point);
}

// A plane's value at a point of a box is off by its error for the largest distance there, and by 8
// roundings of the products of its normal with coordinates.
PlaneSide::PlaneSide(const RoundedPlane& plane, const glm::dvec3& origin,
                     const FaceTree::Box& bounds)
    : normal_(plane.normal) {
    const double extent = norm1(bounds.max - bounds.min);
    const double coordinate = std::max(norm1(bounds.min), norm1(bounds.max));
    limit_ = glm::dot(normal_, origin) - plane.error * extent -
             8 * epsilon * norm1(normal_) * coordinate;
}

}  // namespace lamina
