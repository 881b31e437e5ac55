// SPDX-License-Identifier: Apache-2.0
// Where a pixel must lie: compositing with intervals.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "selftest/interval.h"

namespace lamina::selftest {

// A piece of a ray: what its optical depth and its colour (not associated) can be.
struct PieceBounds {
    Interval depth;
    std::array<Interval, 3> color;
};

// What one blend may add, in full scale: to the fragment's opacity, to its associated colour, and
// to the result; and to opacity and result in proportion to them.
struct BlendRounding {
    double alpha = 0, color = 0, over = 0, relative = 0;

    double absolute() const { return alpha + color + over; }
};

// R, G, B, A: associated.
using PixelBounds = std::array<Interval, 4>;

// `pieces` nearest first. OVER is linear in the fragment's opacity, so its extremes over an
// interval are at the interval's ends: one step loses nothing, and what lies behind is weighted by
// what is left in front of it.
PixelBounds composite(const std::vector<PieceBounds>& pieces, const BlendRounding& rounding);

// The same for pieces that are known exactly, without rounding.
std::array<double, 4> composite_exactly(const std::vector<PieceBounds>& pieces);

}  // namespace lamina::selftest
