// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace lamina {

// Opacity over `share` of the length that `unit_opacity` refers to: 1 - (1 - A)^share (LaMar 2004,
// equations 1 and 2). It is accurate to rounding for every A in [0, 1] and share > 0
// (docs/numerics.md, section 1).
inline double opacity_over(double unit_opacity, double share) {
    if (share == 1) return unit_opacity;
    return unit_opacity < 1 ? -std::expm1(share * std::log1p(-unit_opacity)) : 1.0;
}

}  // namespace lamina
