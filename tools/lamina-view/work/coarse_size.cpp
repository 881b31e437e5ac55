// SPDX-License-Identifier: Apache-2.0
#include "work/coarse_size.h"

#include <algorithm>
#include <cmath>

namespace lamina::view {

void CoarseSize::add(double divisor, double ms) {
    const auto index =
        static_cast<std::size_t>(std::ranges::find(divisors, divisor) - divisors.begin());
    if (ms_[index] > 0)
        for (double& other : ms_) other *= ms / ms_[index];
    ms_[index] = ms;
}

double CoarseSize::expected_ms(std::size_t index) const {
    if (ms_[index] > 0) return ms_[index];
    std::size_t finer = index, coarser = index;
    while (finer > 0 && ms_[finer] == 0) --finer;
    while (coarser + 1 < size && ms_[coarser] == 0) ++coarser;
    const auto pixels = [&](std::size_t i) { return 1 / (divisors[i] * divisors[i]); };
    if (ms_[finer] == 0) return ms_[coarser] * pixels(index) / pixels(coarser);
    if (ms_[coarser] == 0) return ms_[finer] * std::sqrt(pixels(index) / pixels(finer));
    const double share = (pixels(index) - pixels(coarser)) / (pixels(finer) - pixels(coarser));
    return std::lerp(ms_[coarser], ms_[finer], share);
}

double CoarseSize::divisor() const {
    if (std::ranges::max(ms_) == 0) return 4;
    std::array<double, size> ms{};
    for (std::size_t i = 0; i < size; ++i) ms[i] = expected_ms(i);
    const double enough = std::max(target_ms_, 1.25 * std::ranges::min(ms));
    return divisors[static_cast<std::size_t>(
        std::ranges::find_if(ms, [&](double each) { return each <= enough; }) - ms.begin())];
}

}  // namespace lamina::view
