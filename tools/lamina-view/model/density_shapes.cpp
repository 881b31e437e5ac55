// SPDX-License-Identifier: Apache-2.0
#include "model/density_shapes.h"

#include <algorithm>

namespace lamina::view {
namespace {

DensityPoint at_value(double value, double extinction) {
    return {value, extinction, false, 0, {}};
}

}  // namespace

std::vector<DensityPoint> ramp_shape(double lo, double hi, double densest) {
    return {at_value(lo, 0), at_value(hi, densest)};
}

std::vector<DensityPoint> peak_shape(double lo, double hi, double at, double densest) {
    const double half = (hi - lo) / 40;
    const double middle = std::clamp(at, lo + half, hi - half);
    return {at_value(middle - half, 0), at_value(middle, densest), at_value(middle + half, 0)};
}

std::vector<DensityPoint> step_shape(double lo, double hi, double at, double densest) {
    const double edge = std::clamp(at, lo, hi);
    return {at_value(edge, 0), at_value(edge, densest)};
}

}  // namespace lamina::view
