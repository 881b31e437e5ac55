// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/vec3.hpp>

namespace lamina {

inline double norm1(const glm::dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// Returns the corners of the box between two points: corner i has max along x if i & 1, along y if
// i & 2, along z if i & 4.
inline std::array<glm::dvec3, 8> box_corners(const glm::dvec3& min, const glm::dvec3& max) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y,
                      (i & 4) != 0 ? max.z : min.z};
    }
    return corners;
}

// The eye that looks at a mesh. A visibility order depends on nothing else of the view.
struct Eye {
    // World coordinates. For an eye at infinity (orthographic views) it is the viewing direction
    // away from the eye, of any length but 0.
    glm::dvec3 position{0};
    bool at_infinity = false;
};

// Returns the sign (-1, 0 or 1) of det(a - a0, b - b0, c - c0), the three differences as columns
// (Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates,
// 1997). A rounded value is used if its error bound decides the sign, else exact expansions. The
// sign is exact as long as no product of three coordinates overflows or underflows.
int sign_of_determinant(const glm::dvec3& a, const glm::dvec3& a0, const glm::dvec3& b,
                        const glm::dvec3& b0, const glm::dvec3& c, const glm::dvec3& c0);

// Returns the sign of det(b - a, c - a, d - a). 1: d lies on the side of the plane from which a, b,
// c are seen counter-clockwise. 0: the four points are coplanar.
inline int orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d) {
    return sign_of_determinant(b, a, c, a, d, a);
}

}  // namespace lamina
