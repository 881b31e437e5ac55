// SPDX-License-Identifier: Apache-2.0
// The visible part of a ray is the one range that a clip keeps; a tet's segment is visible inside
// it:
//
//   from = 0, to = infinity
//   for each half-space, with the ray's place and direction relative to its plane:
//       at = -place / direction, in twice the precision of double
//       from = at or to = at, whichever is cut; nothing is left if the ray is parallel and outside
//
//   for each segment (enter, leave) of the ray in a tet, in which the scalar is linear:
//       cut it to from .. to, and interpolate the scalar at its new ends
//       it is visible if an interval of the transfer function that its scalars touch has extinction
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "base/arithmetic.h"
#include "mesh/ray_walk.h"
#include "reference/mesh_walk.h"
#include "reference/transfer_intervals.h"
#include "scene/camera.h"
#include "scene/half_space.h"
#include "simd/lane_set.h"

namespace lamina {

// The range from <= z <= to of a viewing ray. It is empty if !(from < to).
struct RaySpan {
    DoubleDouble from, to;
};

// Cuts away everything outside the half-spaces. The numbers of ray and half-spaces are taken as
// exact. A ray in a plane is kept.
void clip_span(std::span<const HalfSpace> clip, const View::Ray& ray, RaySpan& span);

// The range of a ray in front of the eye, or of the eye's plane, that a clip keeps.
struct SeenRange {
    double from, to;
};
SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray);

// The visible part of a tet's segment: parameters of the ray, and the scalar at both ends, between
// which it is linear. It is empty if !(from < to).
struct SeenSegment {
    double from, to;
    double front, back;
};
// `whole`: the segment from the ray's entry into the tet to its exit.
SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen);
SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar);

// The visible parts of a packet's segments (SeenSegment), one a lane.
struct SeenLanes {
    using Row = LaneRow;

    // These rows describe the lines.
    Row first, last;  // SeenRange
    Row world_per_z;  // world length per unit of the parameter

    // These rows describe the segments.
    Row from, to, front, back;  // SeenSegment
    Row length;                 // in world units
    Row slack;                  // scalar_slack()
    LaneSet shown = 0;          // lanes that are not empty and may be visible
};

// Returns the largest error of interpolated scalars inside a tet, from the range of the scalars at
// its corners: 64 epsilons of the larger. Constant scalars are exact.
inline constexpr double scalar_epsilons = 64;
inline double scalar_slack(double least, double most) {
    if (least == most) return 0;
    return scalar_epsilons * std::numeric_limits<double>::epsilon() *
           std::max(std::abs(least), std::abs(most));
}

// Sets `seen` for the segments of a step.
void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen);

}  // namespace lamina
