// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace lamina::view {

// Chooses how small a picture has to be to arrive in time while the camera moves. It keeps the
// times of pictures of each size. A new time scales the others, because views differ in cost.
// Between two sizes with known times, time is linear in the number of pixels. Beyond them, larger
// pictures are expected to take longer in proportion to their pixels, and smaller ones to be faster
// by the square root of that, because part of the work (order of tets) does not depend on size.
class CoarseSize {
  public:
    explicit CoarseSize(double target_ms) : target_ms_(target_ms) {}

    // Records the time of a picture whose edges were divided by this one of `divisors`.
    void add(double divisor, double ms);
    // The least one of `divisors` with which pictures are in time, as far as is known. If there is
    // none, the least one that takes at most a quarter longer than the quickest.
    double divisor() const;

    static constexpr std::array<double, 9> divisors{1, 1.5, 2, 3, 4, 6, 8, 12, 16};

  private:
    static constexpr std::size_t size = divisors.size();

    double expected_ms(std::size_t index) const;

    double target_ms_;
    std::array<double, size> ms_{};  // 0: not known
};

}  // namespace lamina::view
