// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>

namespace lamina {

// The eight corners of the box between two points: corner i has max along x where i & 1, along y
// where i & 2, along z where i & 4.
inline std::array<glm::dvec3, 8> corners_of(const glm::dvec3& min, const glm::dvec3& max) {
    std::array<glm::dvec3, 8> corners;
    for (int i = 0; i < 8; ++i) {
        corners[static_cast<std::size_t>(i)] = {(i & 1) != 0 ? max.x : min.x,
                                                (i & 2) != 0 ? max.y : min.y,
                                                (i & 4) != 0 ? max.z : min.z};
    }
    return corners;
}

}  // namespace lamina
