// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina::view {

// A symmetric-log axis: the distance of numbers on it is their difference below `linear`, and
// follows their ratio far above it, on both sides of 0. Places along it go from 0 at `lo` to 1 at
// `hi`, and on beyond.
class SymlogAxis {
  public:
    // Finite; lo < hi, linear > 0.
    SymlogAxis(double lo, double hi, double linear);

    double lo() const { return lo_; }
    double hi() const { return hi_; }

    // Never falls as the number grows.
    double place(double number) const;
    // The inverse: number(place(x)) is x within
    // 8 e (1 + log1p(m / linear)) (|x| + linear), where m is the largest of |x|, |lo|, |hi| and e
    // the rounding of doubles, 2^-53; and exactly x for lo, hi and, where lo is 0, for 0.
    double number(double place) const;

    // Returns numbers to write along the axis: 0 if it is inside, and powers of 10; at most `most`
    // (>= 3) of them, in order.
    std::vector<double> ticks(int most) const;

  private:
    double curve(double number) const;

    double lo_, hi_, linear_, from_, width_;
};

}  // namespace lamina::view
