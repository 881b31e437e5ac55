// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "base/double_double.h"
#include "lamina/grid.h"

namespace lamina {

// This holds what clip_to_box() needs of a grid, so that it is computed once for all rays.
struct GridAxes {
    // A step of the grid, scaled by a power of two so that its square does not underflow.
    struct Axis {
        glm::dvec3 scaled;
        DoubleDouble inverse_square;  // of the scaled one
        double unscale;               // the power of two
    };

    explicit GridAxes(const Grid& grid);

    glm::dvec3 origin;
    glm::dvec3 lowest, highest;  // corners of the box, in index space
    std::array<Axis, 3> axes;
};

}  // namespace lamina
