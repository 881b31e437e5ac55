// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// Beside a slope of opacity the optical depth over unit_length is at most this: what lies beyond
// is 1 - 4e-8 opaque. Opacity 1 itself has no finite one.
inline constexpr double steepest_optical_depth = 17;

// How far the pieces are from the curve, of its own value. A ray's colours, of points in 0..1, are
// then off by at most half of that, .1 / 255 (docs/precision.md, "Opacity that is linear").
inline constexpr double opacity_slope_tolerance = 7.8e-4;

// Where two pieces meet.
struct OpacitySlopeKnot {
    double share = 0;          // of the way from one end of the slope to the other, inside (0, 1)
    double optical_depth = 0;  // over unit_length
};

// Follows -log1p(-opacity) by straight pieces while opacity goes from `from` to `to` in proportion,
// both in 0..1. The ends are on the curve, or at steepest_optical_depth; the knots between them
// are returned, in order. They are the fewest that keep to the tolerance, and have equal errors.
std::vector<OpacitySlopeKnot> follow_opacity(double from, double to);

}  // namespace lamina
