// SPDX-License-Identifier: Apache-2.0
// Bounds on a pixel, from compositing with intervals.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "selftest/interval.h"

namespace lamina::selftest {

// A piece of a ray: the possible values of its optical depth and of its colour (not associated).
struct PieceBounds {
    Interval depth;
    std::array<Interval, 3> color;
};

// The largest rounding errors of one blend, in full scale: of the fragment's opacity, of its
// associated colour, and of the result; and errors proportional to opacity and to the result.
struct BlendRounding {
    double alpha = 0, color = 0, over = 0, relative = 0;

    double absolute() const { return alpha + color + over; }
};

// R, G, B, A; colour is associated.
using PixelBounds = std::array<Interval, 4>;

// Composites `pieces`, nearest first. OVER is linear in the fragment's opacity, so its extremes
// over an interval lie at the interval's ends, and one step loses nothing. What lies behind is
// weighted by the transmittance of what lies in front.
PixelBounds composite(const std::vector<PieceBounds>& pieces, const BlendRounding& rounding);

// The same for pieces with exact values, without rounding.
std::array<double, 4> composite_exactly(const std::vector<PieceBounds>& pieces);

}  // namespace lamina::selftest
