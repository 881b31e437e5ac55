// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// Limit of the optical depth over unit_length next to a slope of opacity: from this depth on,
// opacity is at least 1 - 4e-8. Opacity 1 itself has no finite depth.
inline constexpr double steepest_optical_depth = 17;

// Largest distance of the pieces from the curve, relative to its value. It changes the colours of a
// ray, of points in 0..1, by at most half of it: .1 / 255 (docs/precision.md, "Opacity that is
// linear").
inline constexpr double opacity_slope_tolerance = 7.8e-4;

// A point at which two pieces meet.
struct OpacitySlopeKnot {
    double share = 0;          // of the way from one end of the slope to the other, inside (0, 1)
    double optical_depth = 0;  // over unit_length
};

// Approximates -log1p(-opacity) by straight pieces while opacity goes linearly from `from` to `to`,
// both in 0..1. The ends lie on the curve, or at steepest_optical_depth; the knots between them are
// returned, in order. Their number is the smallest that keeps to the tolerance, and all pieces have
// the same error.
std::vector<OpacitySlopeKnot> follow_opacity(double from, double to);

}  // namespace lamina
