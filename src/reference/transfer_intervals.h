// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/transfer_function.h"
#include "reference/interval_columns.h"

namespace lamina {

// The colour of a transfer function between two neighbouring knots, by the position x of
// IntervalColumns: color + x * change.
struct IntervalColor {
    glm::dvec3 color{0};
    glm::dvec3 change{0};
};

// A transfer function as a list of intervals. The interval of a value is decided once for each
// piece of a ray, from the values on the piece, so that each side of a step has its own properties.
class TransferIntervals {
  public:
    explicit TransferIntervals(const TransferFunction& transfer_function);

    // Interval i lies between knots i-1 and i.
    const IntervalColor& color(std::size_t interval) const { return colors_[interval]; }
    const IntervalColumns& columns() const { return columns_; }

    // Whether any interval that touches [lo, hi] has extinction.
    bool visible(double lo, double hi) const {
        const std::vector<double>&lows = columns_.visible_lo, &highs = columns_.visible_hi;
        // Most functions have one, and this is asked for every segment of a mesh.
        if (columns_.visible_count == 1) return lows[0] <= hi && lo <= highs[0];
        const auto end = highs.begin() + static_cast<std::ptrdiff_t>(columns_.visible_count);
        const auto range = std::lower_bound(highs.begin(), end, lo);
        return range != end && lows[static_cast<std::size_t>(range - highs.begin())] <= hi;
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
