// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "mesh/ray_walk.h"
#include "scene/camera.h"
#include "scene/half_space.h"

namespace lamina {

// The part of a ray in front of the eye, or of the eye's plane, that a clip keeps.
struct SeenRange {
    double from, to;
};
SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray);

// The part of a tet's segment that is seen: parameters of the ray, and the scalar at both ends,
// between which it is linear. None where !(from < to).
struct SeenSegment {
    double from, to;
    double front, back;
};
// `whole`: the segment from where the ray enters the tet to where it leaves.
SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen);
SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar);

}  // namespace lamina
