// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace lamina {

// What vectors of pieces need of TransferIntervals, field by field. In interval i extinction is
// linear in the position x = (value - lo) * inverse_width, 0 <= x <= 1; outside the outermost knots
// it is constant (change = 0). Columns have room for the longest vector at least.
struct IntervalColumns {
    // Interval i lies between bounds[i] and bounds[i + 1]: the knots, -infinity before them, and
    // infinity behind them, at least as often as to make the knots and one more a power of two.
    std::vector<double> bounds;
    std::size_t knot_count = 0;
    std::vector<double> lo, hi, inverse_width;
    std::vector<double> extinction, extinction_change;  // at lo, and from there to hi
    std::vector<double> extinction_end;                 // at hi
    std::vector<double> color_span;                     // the largest change of a colour
    std::vector<double> transparent;                    // 1 or 0
    // The ranges of values with extinction, as in TransferIntervals::visible(): ascending, then
    // infinity, at least as often as to make them and one more a power of two.
    std::vector<double> visible_lo, visible_hi;
    std::size_t visible_count = 0;
};

}  // namespace lamina
