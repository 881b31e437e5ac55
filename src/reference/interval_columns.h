// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace lamina {

// TransferIntervals field by field, for vectors of pieces.
struct IntervalColumns {
    // Interval i lies between bounds[i] and bounds[i + 1]: the knots, -infinity before them, and
    // infinity behind them, at least as often as to make the knots and one more a power of two.
    std::vector<double> bounds;
    std::size_t knot_count = 0;
    std::vector<double> lo, hi, inverse_width;
    std::vector<double> extinction, extinction_change;  // at lo, and from there to hi
    std::vector<double> color_span;
    std::vector<double> transparent;  // 1 or 0
};

}  // namespace lamina
