// SPDX-License-Identifier: Apache-2.0
#include "model/symlog_axis.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lamina::view {

SymlogAxis::SymlogAxis(double lo, double hi, double linear) : lo_(lo), hi_(hi), linear_(linear) {
    assert(lo < hi && linear > 0);
    from_ = curve(lo);
    width_ = curve(hi) - from_;
}

double SymlogAxis::curve(double number) const {
    return std::copysign(std::log1p(std::abs(number) / linear_), number);
}

double SymlogAxis::place(double number) const {
    return (curve(number) - from_) / width_;
}

double SymlogAxis::number(double place) const {
    if (place == 0) return lo_;
    if (place == 1) return hi_;
    const double along = from_ + place * width_;
    return std::copysign(linear_ * std::expm1(std::abs(along)), along);
}

std::vector<double> SymlogAxis::ticks(int most) const {
    const double largest = std::max(std::abs(lo_), std::abs(hi_));
    const int last = static_cast<int>(std::floor(std::log10(largest)));
    // Below `linear` powers of 10 crowd at 0.
    const int first = std::min(last, static_cast<int>(std::ceil(std::log10(linear_))));
    const int sides = lo_ < 0 && hi_ > 0 ? 2 : 1;
    const int on_a_side = std::max(1, (most - 1) / sides);
    const int step = (last - first) / on_a_side + 1;
    std::vector<double> found;
    for (int power = last; power >= first; power -= step) {
        for (const double number : {std::pow(10., power), -std::pow(10., power)})
            if (number >= lo_ && number <= hi_) found.push_back(number);
    }
    if (lo_ <= 0 && hi_ >= 0) found.push_back(0);
    std::ranges::sort(found);
    return found;
}

}  // namespace lamina::view
