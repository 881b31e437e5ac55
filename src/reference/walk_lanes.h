// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "reference/lane_row.h"

namespace lamina {

// The memory of PacketWalk: a number a line in each row. Lines are as in LineFrame, faces as in
// RayFront and FaceCrossing.
struct WalkLanes {
    static constexpr std::size_t width = longest_vector;
    using Row = LaneRow;
    struct alignas(64) Numbers : std::array<std::int64_t, width> {};

    struct Corner {
        Row x, y, at, reach;
        Row value;
        Numbers point;
    };
    struct Crossing {
        std::array<Row, 3> weights;
        std::array<Numbers, 3> corners;
        Row at, value;
    };

    std::array<Row, 3> origin, direction, across_x, across_y;
    Row direction_square;
    // The corner of the tet that is not in front.
    std::array<Row, 3> top;
    Row top_value;
    Numbers top_point;

    std::array<Corner, 3> front;
    std::array<Row, 3> areas;
    std::array<Crossing, 2> crossings;  // of the tet that is passed: in() and out()
    std::size_t entry = 0;              // the number of in(): what was out() becomes in()
    Crossing& in() { return crossings[entry]; }
    Crossing& out() { return crossings[1 - entry]; }
    const Crossing& in() const { return crossings[entry]; }
    const Crossing& out() const { return crossings[1 - entry]; }
    Row least, most;  // values at the tet's corners

    Numbers left_behind;  // the point of the face of entry that is not in the face of exit
    Numbers settled;      // whether the step is done; 0: floats do not decide it
};

// Takes every line through its tet: from `front`, `top` and in() to out(), and to `front` behind.
// Where floats do not decide the face, these stay as they are.
void step_lanes(WalkLanes& lanes);

}  // namespace lamina
