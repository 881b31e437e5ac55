// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "reference/interval_columns.h"
#include "reference/lane_row.h"
#include "reference/walk_lanes.h"
#include "simd/lane_set.h"

namespace lamina {

// The parts that are seen of a packet's segments (SeenSegment), one a lane.
struct SeenLanes {
    using Row = LaneRow;

    // These rows describe the lines.
    Row first, last;  // SeenRange
    Row world_per_z;  // world length per unit of the parameter

    // These rows describe the segments.
    Row from, to, front, back;  // SeenSegment
    Row length;                 // in world units
    Row slack;                  // scalar_slack()
    LaneSet shown = 0;          // the part is not empty and may show something
};

// How far the interpolation of scalars inside a tet may be off, by the range of the scalars at its
// corners: 64 epsilons of the larger. Constant scalars are exact.
inline constexpr double scalar_epsilons = 64;
inline double scalar_slack(double least, double most) {
    if (least == most) return 0;
    return scalar_epsilons * std::numeric_limits<double>::epsilon() *
           std::max(std::abs(least), std::abs(most));
}

// Sets what `seen` has of the segments of a step.
void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen);

}  // namespace lamina
