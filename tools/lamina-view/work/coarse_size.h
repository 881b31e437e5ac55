// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace lamina::view {

// How small a picture has to be to arrive in time while the camera moves. The time of a picture is
// a fixed part (order of tets, facts of the view) and one that grows with its pixels; both are
// estimated from what pictures took, of which the last ones count most.
class CoarseSize {
  public:
    explicit CoarseSize(double target_ms) : target_ms_(target_ms) {}

    void add(double pixels, double ms);
    // The least number of `divisors` by which both edges may be divided, as far as is known. Where
    // even the fixed part takes too long, fewer pixels help little: then the pixels may take half
    // as long as the fixed part.
    double divisor(int width, int height) const;

    static constexpr std::array<double, 9> divisors{1, 1.5, 2, 3, 4, 6, 8, 12, 16};

  private:
    double budget_pixels() const;

    double target_ms_;
    // Sums over the pictures, weighted: of 1, pixels, ms, pixels^2, pixels * ms.
    double count_ = 0, pixels_ = 0, ms_ = 0, squares_ = 0, products_ = 0;
};

}  // namespace lamina::view
