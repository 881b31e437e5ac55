// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/transfer_function.h"

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

    // Computed from the nearer knot, so that few digits are lost where a steep interval ends at
    // extinction 0.
    double extinction(double value) const {
        const double from_lo = (value - lo) * inverse_width, from_hi = (hi - value) * inverse_width;
        const double result = from_lo < from_hi ? at_lo.extinction + extinction_change * from_lo
                                                : (at_lo.extinction + extinction_change) -
                                                      extinction_change * from_hi;
        return result > 0 ? result : 0;
    }
};

// A transfer function as a list of intervals. The interval of a value is decided once for each
// piece of a ray, from the values on the piece, so that each side of a step has its own properties.
class TransferIntervals {
  public:
    explicit TransferIntervals(const TransferFunction& transfer_function);

    // Interval i lies between knots i-1 and i. above() is the interval for values at and above
    // `value`, below() the one for values at and below it.
    std::size_t above(double value) const;
    std::size_t below(double value) const;
    const TransferInterval& operator[](std::size_t interval) const { return intervals_[interval]; }
    std::size_t knot_count() const { return knots_.size(); }
    double knot(std::size_t index) const { return knots_[index]; }

    // Whether any interval that touches [lo, hi] has extinction.
    bool visible(double lo, double hi) const;
    double brightest() const { return brightest_; }  // largest colour component of all

  private:
    void find_visible();
    void count_knots_below();
    std::size_t knots_surely_below(double value) const;
    template <typename Beyond>
    std::size_t first_knot(double value, const Beyond& beyond) const;

    struct Range {
        double lo, hi;
    };
    std::vector<double> knots_;
    std::vector<TransferInterval> intervals_;
    std::vector<Range> visible_;  // sorted, disjoint
    // The knots' range in equal bins: below all values of a bin lie this many knots at least.
    std::vector<std::uint32_t> knots_below_;
    double bins_per_unit_ = 0;
    double brightest_ = 0;
};

}  // namespace lamina
