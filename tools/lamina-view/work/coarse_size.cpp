// SPDX-License-Identifier: Apache-2.0
#include "work/coarse_size.h"

#include <algorithm>

namespace lamina::view {

void CoarseSize::add(double pixels, double ms) {
    constexpr double kept = .8;
    count_ = kept * count_ + 1;
    pixels_ = kept * pixels_ + pixels;
    ms_ = kept * ms_ + ms;
    squares_ = kept * squares_ + pixels * pixels;
    products_ = kept * products_ + pixels * ms;
}

// Least squares. Sizes that hardly differ say nothing of the fixed part, which is then taken for 0.
double CoarseSize::budget_pixels() const {
    const double mean = pixels_ / count_, mean_ms = ms_ / count_;
    const double variance = squares_ / count_ - mean * mean;
    double fixed = 0, each = mean_ms / mean;
    if (variance > .01 * mean * mean) {
        const double slope = (products_ / count_ - mean * mean_ms) / variance;
        each = std::clamp(slope, 1e-3 * each, each);
        fixed = mean_ms - each * mean;
    }
    return std::max(target_ms_ - fixed, fixed / 2) / each;
}

double CoarseSize::divisor(int width, int height) const {
    if (count_ == 0) return 4;
    const double pixels = static_cast<double>(width) * height, budget = budget_pixels();
    for (const double divisor : divisors)
        if (pixels / (divisor * divisor) <= budget) return divisor;
    return divisors.back();
}

}  // namespace lamina::view
