// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace lamina {

// A line origin + t * direction for all real t, taken as exact, and axes across it.
struct LineFrame {
    glm::dvec3 origin{0}, direction{0};
    glm::dvec3 across_x{0}, across_y{0};  // unit vectors; x, y, direction are right-handed
    double direction_square = 1;
};

}  // namespace lamina
