// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// Field by field, for vectors. In interval i extinction is linear in x = (value - lo) *
// inverse_width, 0 <= x <= 1; outside the knots it is constant. Columns hold a longest vector.
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

// The colour between two knots: color + x * change.
struct IntervalColor {
    glm::dvec3 color{0};
    glm::dvec3 change{0};
};

// The interval is decided once a piece of a ray, so that a step's sides have their own properties.
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
    double brightest() const { return brightest_; }  // largest colour component of all

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
