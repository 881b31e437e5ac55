// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "choice/variation.h"
#include "lamina/transfer_function.h"

namespace lamina {

// A value around which extinction has a peak, so that its isosurface shows.
struct Level {
    double value = 0;
    double half_width = 0;  // > 0, of the peak, in values
    double opacity = 0;     // less than 1, of a ray that crosses the surface once, head-on
    glm::dvec3 color{0};    // from here to the next level
};

// World lengths that extinctions follow from.
struct LevelLengths {
    double thickness = 1;  // over which the inside of a thing gets half the depth of its surface
    double range = 1;  // over which values may change by their whole range, if slopes are unknown
};

// Returns the points that show levels: ascending, on the way from transparent values to `end`. The
// last level is dense up to `end`. Extinctions are per world unit: a ray that crosses a peak meets
// it for as long as the mean slope at that value says.
std::vector<TransferKnot> points_of_levels(const std::vector<Level>& levels, double end,
                                           const glm::dvec3& end_color, const Variation& variation,
                                           const LevelLengths& lengths);

}  // namespace lamina
