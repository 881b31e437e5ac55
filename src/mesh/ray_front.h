// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// A face through which a line enters a tet, as it is seen along the line.
struct RayFront {
    // Its position in the plane across the line, and the line's parameter there.
    struct Corner {
        std::int32_t point;
        double x, y, at;
        double reach;  // bounds the rounding of x and y
    };
    std::array<Corner, 3> corners;  // counter-clockwise
    // Twice the areas of the triangles of the line and the edges 01, 12 and 20. None is negative;
    // it is 0 where rounding alone gave a negative one.
    std::array<double, 3> areas;
};

}  // namespace lamina
