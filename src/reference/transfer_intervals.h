// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// The intervals between a transfer function's knots, one array a field, for SIMD. In each,
// extinction is linear in x = (value - lo) * inverse_width, 0 <= x <= 1; it is constant before the
// first knot and behind the last. Arrays are at least as long as the longest vector.
struct IntervalColumns {
    // Interval i lies between bounds[i] and bounds[i + 1]. The array holds -infinity, the knots,
    // and then infinity, repeated until the knots and the infinities are at least a power of two.
    std::vector<double> bounds;
    std::size_t knot_count = 0;
    std::vector<double> lo, hi, inverse_width;
    std::vector<double> extinction, extinction_change;  // at lo, and from there to hi
    std::vector<double> extinction_end;                 // at hi
    std::vector<double> color_span;   // the largest change of a colour component from lo to hi
    std::vector<double> transparent;  // 1 or 0
    // The ranges of values with extinction, for TransferIntervals::visible(): ascending, then
    // infinity, repeated until the number of entries is a power of two above visible_count.
    std::vector<double> visible_lo, visible_hi;
    std::size_t visible_count = 0;
};

// The colour in an interval: color + x * change.
struct IntervalColor {
    glm::dvec3 color{0};
    glm::dvec3 change{0};
};

// The intervals of a transfer function, with colours. The tracer chooses the interval once for each
// piece of a ray, so both sides of a step keep their own optics.
class TransferIntervals {
  public:
    explicit TransferIntervals(const TransferFunction& transfer_function);

    const IntervalColor& color(std::size_t interval) const { return colors_[interval]; }
    const IntervalColumns& columns() const { return columns_; }

    // Tells whether any interval that touches [lo, hi] has extinction.
    bool visible(double lo, double hi) const {
        const std::vector<double>&lows = columns_.visible_lo, &highs = columns_.visible_hi;
        // Most functions have a single range, and every segment of a mesh asks for this.
        if (columns_.visible_count == 1) return lows[0] <= hi && lo <= highs[0];
        const auto end = highs.begin() + static_cast<std::ptrdiff_t>(columns_.visible_count);
        const auto range = std::lower_bound(highs.begin(), end, lo);
        return range != end && lows[range - highs.begin()] <= hi;
    }
    double brightest() const { return brightest_; }  // largest component of any colour

  private:
    void add(const TransferKnot& from, const TransferKnot& to);
    void add_constant(const TransferKnot& knot);
    void find_visible();
    void make_room();

    std::vector<IntervalColor> colors_;
    IntervalColumns columns_;
    double brightest_ = 0;
};

}  // namespace lamina
