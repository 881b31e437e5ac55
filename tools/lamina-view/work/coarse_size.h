// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace lamina::view {

// How small a picture has to be to arrive in time while the camera moves. It keeps what pictures
// of each size took. A new time scales the others along, as views differ in what they take. Between
// two sizes that are known, time is linear in the number of pixels; beyond them, larger pictures
// are expected to take as much longer as they have more pixels, and smaller ones the square root of
// that shorter, as part of the work (order of tets) is the same for all.
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
