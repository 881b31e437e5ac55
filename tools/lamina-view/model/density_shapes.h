// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/transfer_curves.h"

namespace lamina::view {

// Simple curves of extinction over values from lo to hi > lo, up to `densest`.
std::vector<DensityPoint> ramp_shape(double lo, double hi, double densest);
// A hat a twentieth of the range wide, around a value that is kept inside, and 0 elsewhere.
std::vector<DensityPoint> peak_shape(double lo, double hi, double at, double densest);
// 0 up to a value, `densest` from there on.
std::vector<DensityPoint> step_shape(double lo, double hi, double at, double densest);

}  // namespace lamina::view
