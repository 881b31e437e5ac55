// SPDX-License-Identifier: Apache-2.0
// Exact signs of geometric determinants (Shewchuk, Adaptive precision floating-point arithmetic and
// fast robust geometric predicates, 1997). A rounded value is used where its error bound decides
// the sign, and exact expansions elsewhere. The sign is exact as long as no product of three
// coordinates overflows or underflows.
#pragma once

#include <glm/vec3.hpp>

namespace lamina {

// -1, 0 or 1: the sign of det(a - a0, b - b0, c - c0), the three differences as columns.
int sign_of_determinant(const glm::dvec3& a, const glm::dvec3& a0, const glm::dvec3& b,
                        const glm::dvec3& b0, const glm::dvec3& c, const glm::dvec3& c0);

// The sign of det(b - a, c - a, d - a). 1: d lies on the side of the plane from which a, b, c are
// seen counter-clockwise. 0: the four points are coplanar.
inline int orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d) {
    return sign_of_determinant(b, a, c, a, d, a);
}

}  // namespace lamina
