// SPDX-License-Identifier: Apache-2.0
#include "volume/portable_math.h"

#include <cmath>
#include <numbers>

namespace lamina {

double portable_exp(double x) {
    // x = n ln 2 + r, |r| <= ln 2 / 2; ln 2 in two parts, of which n times the first is exact.
    constexpr double ln2_high = 0x1.62e42feep-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    const double n = std::floor(x / std::numbers::ln2 + 0.5);
    const double r = (x - n * ln2_high) - n * ln2_low;
    double series = 1;  // Taylor, by Horner; the term left out is below 0.35^15 / 15! = 1e-19
    for (int term = 14; term >= 1; --term) series = 1 + series * r / term;
    return std::ldexp(series, static_cast<int>(n));
}

double portable_cos_turns(double turns) {
    const double nearest = std::floor(turns + 0.5);
    double part = std::abs(turns - nearest);  // 0..1/2
    const bool second_quarter = part > 0.25;
    if (second_quarter) part = 0.5 - part;
    const double angle = 2 * std::numbers::pi * part;  // 0..pi/2
    double series = 1;  // Taylor, by Horner; the term left out is below (pi/2)^24 / 24! = 1e-19
    for (int term = 22; term >= 2; term -= 2)
        series = 1 - series * angle * angle / (term * (term - 1));
    return second_quarter ? -series : series;
}

}  // namespace lamina
