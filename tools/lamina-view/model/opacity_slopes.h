// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/transfer_curves.h"

namespace lamina::view {

// Convert between opacity over a length of a medium and its extinction. That of opacity 1 is
// finite, 1e7 / length, as in scene files (docs/scene.md, "Opacity").
double opacity_of(double extinction, double length);
double extinction_of(double opacity, double length);

// Returns the knots inside a slope from a to b along which opacity over a.opacity_length > 0 world
// units is linear.
std::vector<ExtinctionKnot> inside_slope(const DensityPoint& a, const DensityPoint& b);

// Makes points of knots. Successive smooth knots, which a program may have sampled from any curve,
// become a slope if they follow an opacity: over `unit_length` if that fits, else over the length
// that fits best.
std::vector<DensityPoint> with_slopes(const std::vector<ExtinctionKnot>& knots, double unit_length);

}  // namespace lamina::view
