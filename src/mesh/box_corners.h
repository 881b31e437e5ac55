// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace lamina {

// The corners of the box between two points: corner i has max along x where i & 1, along y where
// i & 2, along z where i & 4.
inline std::array<glm::dvec3, 8> box_corners(const glm::dvec3& min, const glm::dvec3& max) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y,
                      (i & 4) != 0 ? max.z : min.z};
    }
    return corners;
}

}  // namespace lamina
