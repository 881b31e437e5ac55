// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/transfer_curves.h"

namespace lamina::view {

// A slope is a curve on which opacity over a given length, not extinction, is linear.

// Convert between opacity over a length of a medium and its extinction. Opacity 1 has the finite
// extinction 1e7 / length, as in scene files (docs/scene.md, "Opacity").
double opacity_of(double extinction, double length);
double extinction_of(double opacity, double length);

// Returns the knots between a and b if opacity over a.opacity_length > 0 world units is linear
// there.
std::vector<ExtinctionKnot> inside_slope(const DensityPoint& a, const DensityPoint& b);

// Turns knots into points. Successive smooth knots become a slope if they follow a linear opacity.
// The length is unit_length if that fits, and otherwise the best-fitting one.
std::vector<DensityPoint> with_slopes(const std::vector<ExtinctionKnot>& knots, double unit_length);

}  // namespace lamina::view
