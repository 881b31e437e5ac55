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

// Returns the corners of a box: corner i has max along x if i & 1, y if i & 2, z if i & 4.
inline std::array<glm::dvec3, 8> box_corners(const glm::dvec3& min, const glm::dvec3& max) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y,
                      (i & 4) != 0 ? max.z : min.z};
    }
    return corners;
}

// The eye that looks at a mesh: all of a view that a visibility order depends on.
struct Eye {
    // In world coordinates. If at_infinity (orthographic): the view direction, away from the eye.
    glm::dvec3 position{0};
    bool at_infinity = false;
};

// Returns the exact sign of det(a - a0, b - b0, c - c0), barring over- and underflow (Shewchuk,
// Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997).
int sign_of_determinant(const glm::dvec3& a, const glm::dvec3& a0, const glm::dvec3& b,
                        const glm::dvec3& b0, const glm::dvec3& c, const glm::dvec3& c0);

// Returns, exactly: 1 if a, b, c look counter-clockwise from d, -1 if clockwise, 0 if coplanar.
inline int orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d) {
    return sign_of_determinant(b, a, c, a, d, a);
}

}  // namespace lamina
