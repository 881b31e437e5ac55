// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/transfer_function.h"
#include "reference/interval_columns.h"

namespace lamina {

// A transfer function between two neighbouring knots, where colour and extinction are linear in the
// position x = (value - lo) * inverse_width, 0 <= x <= 1. Outside the outermost knots both are
// constant (changes = 0).
struct TransferInterval {
    double lo = 0;
    double hi = 1;
    double inverse_width = 1;
    OpticalProperties at_lo;
    glm::dvec3 color_change{0};
    double extinction_change = 0;
    double color_span = 0;  // largest |color_change|
    bool transparent = true;
};

// A transfer function as a list of intervals. The interval of a value is decided once for each
// piece of a ray, from the values on the piece, so that each side of a step has its own properties.
class TransferIntervals {
  public:
    explicit TransferIntervals(const TransferFunction& transfer_function);

    // Interval i lies between knots i-1 and i.
    const TransferInterval& operator[](std::size_t interval) const { return intervals_[interval]; }
    const IntervalColumns& columns() const { return columns_; }

    // Whether any interval that touches [lo, hi] has extinction.
    bool visible(double lo, double hi) const {
        // Most functions have one, and this is asked for every cell.
        if (visible_.size() == 1) return visible_[0].lo <= hi && lo <= visible_[0].hi;
        const auto range =
            std::lower_bound(visible_.begin(), visible_.end(), lo,
                             [](const Range& r, double value) { return r.hi < value; });
        return range != visible_.end() && range->lo <= hi;
    }
    double brightest() const { return brightest_; }  // largest colour component of all

  private:
    void find_visible();
    void make_columns();

    struct Range {
        double lo, hi;
    };
    std::vector<double> knots_;
    std::vector<TransferInterval> intervals_;
    std::vector<Range> visible_;  // sorted, disjoint
    IntervalColumns columns_;
    double brightest_ = 0;
};

}  // namespace lamina
