// SPDX-License-Identifier: Apache-2.0
// Opacity, extinction and optical depth (LaMar 2004, equations 1 and 2; docs/numerics.md,
// section 1).
#pragma once

#include <cmath>

namespace lamina {

// Opacity 1 has no finite extinction. This optical depth over unit_length stands for it.
inline constexpr double opaque_optical_depth = 1e7;

inline double opacity_from_depth(double optical_depth) {
    return -std::expm1(-optical_depth);
}

// Returns the extinction per world unit that gives `opacity` in [0, 1] over `unit_length` > 0 world
// units.
inline double extinction_from_opacity(double opacity, double unit_length) {
    return (opacity < 1 ? -std::log1p(-opacity) : opaque_optical_depth) / unit_length;
}

}  // namespace lamina
