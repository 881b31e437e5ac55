// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "lamina/tet.h"

namespace lamina {

// A face through which a line enters a tet, as it is seen along the line.
struct RayFront {
    // A corner: its position in the plane across the line, and the line's parameter there.
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

// The corner of a tet that is not among three of its corners.
inline std::int32_t corner_opposite(const Tet& tet, std::int32_t a, std::int32_t b,
                                    std::int32_t c) {
    return tet[0] ^ tet[1] ^ tet[2] ^ tet[3] ^ a ^ b ^ c;  // the others cancel
}

}  // namespace lamina
