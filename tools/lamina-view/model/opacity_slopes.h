// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/transfer_curves.h"

namespace lamina::view {

// A slope is a part of the curve on which opacity over some length is linear, not extinction.

// Convert between opacity over a length of a medium and its extinction. Opacity 1 has the finite
// extinction 1e7 / length, as in scene files (docs/scene.md, "Opacity").
double opacity_of(double extinction, double length);
double extinction_of(double opacity, double length);

// Returns the knots of the slope from a to b, over a.opacity_length > 0 world units.
std::vector<ExtinctionKnot> inside_slope(const DensityPoint& a, const DensityPoint& b);

// Turns knots into points. Successive smooth knots become a slope if they follow a linear opacity
// over unit_length, or else over the length that fits best (world units).
std::vector<DensityPoint> with_slopes(const std::vector<ExtinctionKnot>& knots, double unit_length);

}  // namespace lamina::view
